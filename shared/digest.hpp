// The canonical digest of a mesh: a sum over its triangles, so that their order does not matter.
#ifndef MICROTIN_SHARED_DIGEST_HPP
#define MICROTIN_SHARED_DIGEST_HPP

#include "shared/lattice.hpp"

namespace microtin {

inline uint64_t digest_u16(uint64_t hash, uint32_t value) {
  const uint64_t prime = 0x100000001B3u;
  hash = (hash ^ (value & 255u)) * prime;
  return (hash ^ (value >> 8 & 255u)) * prime;
}

// FNV-1a, 64 bits, of x, y, z of the corners, counter-clockwise from the lexicographically
// smallest, low bytes first, then a void flag of two bytes.
inline uint64_t triangle_digest(const Vertex corner[3], bool is_void) {
  uint32_t first = 0;
  for (uint32_t i = 1; i < 3; ++i) {
    const Point p = {corner[i].x, corner[i].y}, least = {corner[first].x, corner[first].y};
    if (p < least) first = i;
  }
  uint64_t hash = 0xCBF29CE484222325u;
  for (uint32_t i = 0; i < 3; ++i) {
    const Vertex& v = corner[(first + i) % 3];
    hash = digest_u16(hash, v.x);
    hash = digest_u16(hash, v.y);
    hash = digest_u16(hash, static_cast<uint16_t>(v.z));
  }
  return digest_u16(hash, is_void ? 1u : 0u);
}

}  // namespace microtin

#endif
