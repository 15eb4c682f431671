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
  uint16_t words[10];
  for (uint32_t i = 0; i < 3; ++i) {
    const Vertex& v = corner[(first + i) % 3];
    words[3 * i] = v.x;
    words[3 * i + 1] = v.y;
    words[3 * i + 2] = static_cast<uint16_t>(v.z);
  }
  words[9] = is_void;
  uint64_t hash = 0xCBF29CE484222325u;
  for (uint32_t i = 0; i < 20; ++i) {
    const uint32_t byte = static_cast<uint32_t>(words[i / 2]) >> (i % 2 * 8) & 255u;
    hash = (hash ^ byte) * 0x100000001B3u;
  }
  return hash;
}

}  // namespace microtin

#endif
