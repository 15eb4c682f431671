// Small terrains and their streams, for tests of the decoder.
#ifndef MICROTIN_TESTS_STREAMS_HPP
#define MICROTIN_TESTS_STREAMS_HPP

#include <cmath>
#include <random>
#include <set>

#include "encoder/encode.hpp"

namespace microtin {

// `n` vertices at random distinct places of a 1000 x 800 lattice, with rolling heights.
inline Tin rolling_tin(uint32_t n, uint32_t seed) {
  std::mt19937 random(seed);
  std::set<Point> places;
  while (places.size() < n) {
    places.insert(
        Point{static_cast<uint16_t>(random() % 1000), static_cast<uint16_t>(random() % 800)});
  }
  Tin tin;
  for (const Point& p : places) {
    const double height = 300 * std::sin(p.x / 90.0) * std::cos(p.y / 70.0) + random() % 9;
    tin.vertices.push_back(Vertex{p.x, p.y, static_cast<int16_t>(height)});
  }
  return tin;
}

inline std::vector<uint8_t> terrain_stream(uint32_t n, uint32_t seed,
                                           uint32_t degree = kDefaultDegree) {
  return encode(rolling_tin(n, seed), Metadata(), degree);
}

}  // namespace microtin

#endif
