// SPDX-License-Identifier: MIT
// The canonical digest of a mesh: a sum over its triangles, so that their order does not matter.
#ifndef MICROTIN_SHARED_DIGEST_HPP
#define MICROTIN_SHARED_DIGEST_HPP

#include "shared/lattice.hpp"

namespace microtin {

// FNV-1a, 64 bits, of x, y, z of the corners, counter-clockwise from the lexicographically
// smallest, low bytes first, then a void flag of two bytes.
inline uint64_t triangle_digest(const Vertex corner[3], bool is_void) {
  uint32_t first = 0;
  for (uint32_t i = 1; i < 3; ++i) {
    const Point p = {corner[i].x, corner[i].y}, least = {corner[first].x, corner[first].y};
    if (p < least) first = i;
  }
  static_assert(sizeof(Vertex) == 3 * sizeof(uint16_t), "corners are nine words in a row");
  const uint8_t* const words = reinterpret_cast<const uint8_t*>(corner);
  uint64_t hash = 0xCBF29CE484222325u;
  for (uint32_t i = 0, at = 3 * first; i < 10; ++i, at = at == 8 ? 0 : at + 1) {
    uint16_t word = is_void;
    if (i < 9) __builtin_memcpy(&word, words + 2 * at, sizeof word);
    for (uint32_t k = 0; k < 2; ++k, word >>= 8) hash = (hash ^ (word & 255u)) * 0x100000001B3u;
  }
  return hash;
}

}  // namespace microtin

#endif
