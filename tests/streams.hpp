// Small terrains and their streams, for tests of the decoder.
#ifndef MICROTIN_TESTS_STREAMS_HPP
#define MICROTIN_TESTS_STREAMS_HPP

#include <cmath>

#include "encoder/encode.hpp"
#include "tests/point_sets.hpp"

namespace microtin {

// About `n` vertices at random places of a 1000 x 1000 lattice, with rolling heights.
inline Tin rolling_tin(uint32_t n, uint32_t seed) {
  Random random(seed);
  Tin tin;
  for (const Point p : uniform_points(n, random, 1000)) {
    const double height = 300 * std::sin(p.x / 90.0) * std::cos(p.y / 70.0);
    tin.vertices.push_back(
        Vertex{p.x, p.y, static_cast<int16_t>(std::lround(height) + random.below(9))});
  }
  return tin;
}

inline std::vector<uint8_t> terrain_stream(uint32_t n, uint32_t seed, const Effort& effort = {}) {
  return encode(rolling_tin(n, seed), Metadata(), effort);
}

}  // namespace microtin

#endif
