// SPDX-License-Identifier: MIT
// Small terrains and their streams, for tests of the decoder.
#ifndef MICROTIN_TESTS_SUPPORT_STREAMS_HPP
#define MICROTIN_TESTS_SUPPORT_STREAMS_HPP

#include <cmath>

#include "encoder/base/error.hpp"
#include "encoder/stream/encode.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/mesh_copy.hpp"
#include "tests/support/point_sets.hpp"

namespace microtin::tests {

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

// A header with everything in it.
inline Metadata full_metadata() {
  Metadata m;
  m.placement.x = {7 * 1200, 1, 1200};
  m.placement.y = {-33 * 1200, 1, 1200};
  m.placement.z = {-250, 5, 2};
  m.horizontal_unit = Unit::kDegree;
  m.vertical_unit = Unit::kMetre;
  m.horizontal_epsg = 4326;
  m.vertical_epsg = 5773;
  m.source = "golden";
  m.accuracy = Accuracy{Decimal{10, 0}, Decimal{99, 1}, Decimal{345, 2}, Decimal{-12, 2}};
  m.grid = PostGrid{1201, 1201, {7 * 1200, 1, 1200}, {-33 * 1200, 1, 1200}};
  return m;
}

// Every third real triangle void.
inline Tin with_voids(Tin tin) {
  const DecodedTerrain decoded(encode(tin, Metadata()));
  const MeshCopy copy(decoded.mesh());
  size_t i = 0;
  for (const std::array<Point, 3>& t : triangles_of(copy.mesh).triangles) {
    if (i++ % 3 == 0) tin.voids.push_back(Tin::Triangle{t[0], t[1], t[2]});
  }
  return tin;
}

}  // namespace microtin::tests

#endif
