// SPDX-License-Identifier: MIT
// Heights: against exact rational arithmetic, from any start, on edges and vertices, in voids.
#include <doctest/doctest.h>

#include <cstdlib>

#include "tests/support/point_sets.hpp"
#include "tests/support/reference_heights.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {
namespace {

using reference::Corners;
using reference::real_triangles;
using reference::rounded;
using reference::Wide;

// The heights at a place of all closed triangles that hold it: none, or all the same.
std::vector<int32_t> exact_heights(const std::vector<Corners>& triangles, int32_t x, int32_t y) {
  std::vector<int32_t> heights;
  for (const Corners& t : triangles) {
    if (reference::holds(t, x, y)) heights.push_back(reference::height_in(t, x, y));
  }
  return heights;
}

Tin random_tin(const Points& points, Random& random) {
  Tin tin;
  for (const Point p : points) {
    tin.vertices.push_back(Vertex{p.x, p.y, static_cast<int16_t>(random.below(65536) - 32768)});
  }
  return tin;
}

}  // namespace

TEST_CASE("heights equal the exact plane, rounded, from any start and from either side") {
  Random random(21);
  int inside = 0, on_edges = 0;
  for (const PointSet& set : point_sets(60, 21)) {
    const Tin tin = random_tin(set.points, random);
    const DecodedTerrain terrain(encode(tin, Metadata()));
    const std::vector<Corners> triangles = real_triangles(terrain.mesh());
    for (int probe = 0; probe < 300; ++probe) {
      // Anywhere in the bounds, or on the line between two vertices, or at a vertex.
      const Vertex& p = tin.vertices[random.below(static_cast<uint32_t>(tin.vertices.size()))];
      const Vertex& q = tin.vertices[random.below(static_cast<uint32_t>(tin.vertices.size()))];
      int32_t x = p.x * 256, y = p.y * 256;
      if (probe % 3 == 0) {
        x = (p.x + q.x) * 128;
        y = (p.y + q.y) * 128;
      } else if (probe % 3 == 1) {
        x = static_cast<int32_t>(random.below(65535 * 256 + 1));
        y = static_cast<int32_t>(random.below(65535 * 256 + 1));
        if (probe % 2 == 0) {
          x = p.x * 256 + (q.x - p.x) * static_cast<int32_t>(random.below(256));
          y = q.y * 256 + (p.y - q.y) * static_cast<int32_t>(random.below(256));
        }
      }
      const std::vector<int32_t> expected = exact_heights(triangles, x, y);
      uint32_t hint = random.below(microtin_mesh_triangle_count(terrain.mesh()));
      int32_t height = 0;
      const microtin_query_result answer =
          microtin_mesh_height_at(terrain.mesh(), x, y, &hint, &height, 0, 0);
      CAPTURE(set.name);
      CHECK(answer == (expected.empty() ? MICROTIN_QUERY_OUTSIDE : MICROTIN_QUERY_OK));
      for (const int32_t e : expected) CHECK(height == e);
      inside += !expected.empty();
      on_edges += expected.size() > 1;
    }
  }
  CHECK(inside > 500);
  CHECK(on_edges > 200);
}

TEST_CASE("extreme heights and the largest triangle do not overflow") {
  const Tin tin{{{0, 0, -32768}, {65535, 0, 32767}, {0, 65535, 32767}, {65535, 65535, -32768}}, {}};
  const DecodedTerrain terrain(encode(tin, Metadata()));
  const std::vector<Corners> triangles = real_triangles(terrain.mesh());
  Random random(22);
  for (int probe = 0; probe < 2000; ++probe) {
    const int32_t x = static_cast<int32_t>(random.below(65535 * 256 + 1));
    const int32_t y = static_cast<int32_t>(random.below(65535 * 256 + 1));
    uint32_t hint = 0;
    int32_t height = 0;
    REQUIRE(microtin_mesh_height_at(terrain.mesh(), x, y, &hint, &height, 0, 0) ==
            MICROTIN_QUERY_OK);
    CHECK(height == exact_heights(triangles, x, y).at(0));
  }
}

TEST_CASE("voids: valid terrain wins on shared edges, and a vertex knows its own height") {
  // A square of four vertices around a centre; the triangle to the west is void.
  Tin tin{{{0, 0, 1}, {20, 0, 2}, {0, 20, 3}, {20, 20, 4}, {10, 10, 5}}, {}};
  tin.voids.push_back(Tin::Triangle{{0, 0}, {10, 10}, {0, 20}});
  const DecodedTerrain terrain(encode(tin, Metadata()));
  const auto answer = [&](double x, double y, int32_t* height) {
    uint32_t hint = 0;
    return microtin_mesh_height_at(terrain.mesh(), static_cast<int32_t>(x * 256),
                                   static_cast<int32_t>(y * 256), &hint, height, 0, 0);
  };
  int32_t height = 0;
  CHECK(answer(4, 10, &height) == MICROTIN_QUERY_VOID);
  CHECK(answer(0, 10, &height) == MICROTIN_QUERY_VOID);  // on the hull, void on its only side
  CHECK(answer(16, 10, &height) == MICROTIN_QUERY_OK);
  CHECK(answer(5, 5, &height) == MICROTIN_QUERY_OK);  // on the edge of the void
  CHECK(height == 3 * 65536);
  CHECK(answer(10, 10, &height) == MICROTIN_QUERY_OK);
  CHECK(height == 5 * 65536);
  CHECK(answer(0, 20, &height) == MICROTIN_QUERY_OK);
  CHECK(height == 3 * 65536);
  CHECK(answer(20.5, 10, &height) == MICROTIN_QUERY_OUTSIDE);
}

TEST_CASE("real coordinates convert to the lattice exactly") {
  const auto to_lattice = [](const microtin_axis& axis, int64_t value, uint32_t per_unit) {
    int32_t lattice = -1;
    return microtin_axis_to_lattice(&axis, value, per_unit, &lattice) == MICROTIN_STATUS_OK
               ? lattice
               : -1;
  };
  // A degree cell in steps of 1/1200 degree from 7 degrees east, asked in 1e-7 degrees.
  const microtin_axis east = {7 * 1200, 1, 1200};
  CHECK(to_lattice(east, 70000000, 10000000) == 0);
  CHECK(to_lattice(east, 80000000, 10000000) == 1200 * 256);
  CHECK(to_lattice(east, 75000000, 10000000) == 600 * 256);
  CHECK(to_lattice(east, 69999999, 10000000) == 0);   // less than half a 1/256 step outside
  CHECK(to_lattice(east, 69999000, 10000000) == -1);  // outside
  const microtin_axis south = {-33 * 1200, 1, 1200};
  CHECK(to_lattice(south, -330000000, 10000000) == 0);
  CHECK(to_lattice(south, -325000000, 10000000) == 600 * 256);

  const int64_t far = int64_t{1} << 61;  // offsets lie within
  CHECK(to_lattice({-far, 1, 1}, far, 1) == -1);
  CHECK(to_lattice({far, 1, 1}, -far, 1) == -1);
  CHECK(to_lattice({1 - far, 1, 1}, 3 - far, 1) == 2 * 256);
  const int64_t step = (int64_t{1} << 40) - 1;
  const microtin_axis unit = {far - 1, static_cast<uint64_t>(step), static_cast<uint64_t>(step)};
  CHECK(to_lattice(unit, far / step + 65535, 1) == 65535 * 256);

  // Against rational arithmetic, on random axes.
  Random random(23);
  int inside = 0;
  for (int round = 0; round < 200000; ++round) {
    const auto bits = [&](uint32_t most) {
      const uint64_t wide = random.next() >> 2;
      return static_cast<int64_t>(wide >> (62 - 1 - random.below(most)));
    };
    const microtin_axis axis = {bits(61) * (round % 2 == 0 ? 1 : -1),
                                static_cast<uint64_t>(bits(40) | 1),
                                static_cast<uint64_t>(bits(40) | 1)};
    const uint32_t per_unit = 1u + random.below(1u << (1 + random.below(24)));
    // Aim at a lattice value, most within range.
    const int64_t k = static_cast<int64_t>(random.below(66000)) - 200;
    const Wide target = (Wide{axis.offset} + Wide(axis.numerator) * k) * per_unit;
    const Wide value = target / Wide(axis.denominator) + Wide(random.below(7)) - 3;
    if (value > INT64_MAX || value < INT64_MIN) continue;
    const Wide steps = value * Wide(axis.denominator) - Wide{axis.offset} * per_unit;
    const Wide expected = rounded(steps * 256, Wide(axis.numerator) * per_unit);
    const bool in_range = expected >= 0 && expected <= 65535 * 256;
    const int32_t found = to_lattice(axis, static_cast<int64_t>(value), per_unit);
    CHECK(found == (in_range ? static_cast<int32_t>(expected) : -1));
    inside += in_range;
  }
  CHECK(inside > 50000);
}

}  // namespace microtin::tests
