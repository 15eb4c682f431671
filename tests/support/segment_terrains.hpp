// SPDX-License-Identifier: MIT
// Small terrains, in both forms, and segments on them.
#ifndef MICROTIN_TESTS_SUPPORT_SEGMENT_TERRAINS_HPP
#define MICROTIN_TESTS_SUPPORT_SEGMENT_TERRAINS_HPP

#include <doctest/doctest.h>

#include <utility>

#include "microtin/microtin.hpp"
#include "tests/support/forged_pack.hpp"
#include "tests/support/reference_segment.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {

constexpr uint32_t kBothCapacity = 400;

// A terrain twice: as a mesh, and compact.
struct Both {
  Terrain<kBothCapacity> mesh, made;
  CompactTerrain<kBothCapacity> compact;

  explicit Both(const Bytes& stream) {
    Decoder<kBothCapacity> decoder(mesh);
    size_t used = 0;
    REQUIRE(decoder.feed(stream.data(), stream.size(), &used) == MICROTIN_STATUS_OK);
    decoder.begin(made);
    REQUIRE(decoder.feed(stream.data(), stream.size(), &used) == MICROTIN_STATUS_OK);
    REQUIRE(compact.make(made, decoder) == MICROTIN_STATUS_OK);
  }
};

inline Tin small_tin(uint32_t seed) {
  Random random(seed);
  const uint32_t side = 4 + random.below(20);
  Points points = uniform_points(4 + random.below(60), random, side);
  points.push_back(point(side, side + 1));
  points.push_back(point(side + 1, side));
  Tin tin;
  for (const Point p : points) {
    tin.vertices.push_back({p.x, p.y, static_cast<int16_t>(random.below(2000) - 1000)});
  }
  return seed % 3 == 0 ? tin : with_voids(tin);
}

// Ends lie at whole steps or anywhere, also outside the terrain. Some segments run along an axis,
// and some are single positions.
inline microtin_segment small_segment(Random& random, int64_t side) {
  const int64_t unit = random.below(3) == 0 ? 1 : 256;
  const auto pick = [&] {
    return static_cast<int64_t>(random.below(static_cast<uint32_t>(side * 256))) / unit * unit;
  };
  microtin_segment c = {pick(), pick(), pick(), pick()};
  const uint32_t kind = random.below(8);
  if (kind == 0 || kind == 2) c.x_end = c.x;
  if (kind == 1 || kind == 2) c.y_end = c.y;
  return c;
}

// Some of 3 x 3 vertices, where nearly everything is degenerate: lines through vertices, along
// edges and the hull, past corners of it.
inline Tin tiny_tin(uint32_t seed) {
  Random random(seed);
  Tin tin;
  for (uint16_t k = 0; k < 9; ++k) {
    if (seed % 4 != 0 && random.below(3) == 0) continue;
    tin.vertices.push_back({static_cast<uint16_t>(1 + k % 3), static_cast<uint16_t>(1 + k / 3),
                            static_cast<int16_t>(random.below(9) - 4)});
  }
  if (!has_triangle(tin)) tin.vertices = {{1, 1, 5}, {3, 1, -5}, {2, 3, 1}};
  return seed % 3 == 0 ? tin : with_some_voids(std::move(tin), random, 40);
}

// Between places half a step apart, in and around it.
inline microtin_segment tiny_segment(Random& random) {
  const auto pick = [&] { return static_cast<int64_t>(random.below(9)) * 128; };
  return {pick(), pick(), pick(), pick()};
}

// Calls check(terrain, surface, segment, is_tiny, random) for many segments on tiny and on small
// terrains in turn.
template <class Check>
void for_each_segment(const Check& check) {
  for (uint32_t seed = 0; seed < 120; ++seed) {
    CAPTURE(seed);
    const bool is_tiny = seed % 2 == 0;
    const Both terrain(
        encode(is_tiny ? tiny_tin(seed) : small_tin(seed), Metadata(), Effort{32, Coding::kQuick}));
    reference::Surface surface;
    surface.add(terrain.mesh.mesh(), 0, 0);
    Random random(seed);
    for (int i = 0; i < 80; ++i) {
      const microtin_segment c = is_tiny ? tiny_segment(random) : small_segment(random, 27);
      check(terrain, surface, c, is_tiny, random);
    }
  }
}

}  // namespace microtin::tests

#endif
