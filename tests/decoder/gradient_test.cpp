// SPDX-License-Identifier: MIT
// Gradients, heights at many positions, and extremes of grids, on all forms: against all triangles.
#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "tests/support/pack_device.hpp"
#include "tests/support/pack_segments.hpp"
#include "tests/support/packs.hpp"
#include "tests/support/segment_terrains.hpp"

namespace microtin::tests {
namespace {

using namespace reference;

// The triangle of which the gradient is returned, by definition; null if there is none.
const Facet* facet_at(const Surface& surface, int64_t x, int64_t y) {
  const Facet* best = nullptr;
  std::array<int64_t, 2> most = {};
  for (const Facet& t : surface.facets) {
    bool holds = true;
    std::array<int64_t, 2> centre = {};
    for (size_t i = 0; i < 3; ++i) {
      holds = holds && area(t.v[i], t.v[(i + 1) % 3], x, y) >= 0;
      centre[0] += t.v[i][0];
      centre[1] += t.v[i][1];
    }
    if (!holds || (best != nullptr && centre < most)) continue;
    best = &t;
    most = centre;
  }
  return best;
}

// The plane through the corners has this gradient.
bool is_gradient_of(const Facet& t, const microtin_gradient& g) {
  if (g.whole <= 0) return false;
  for (size_t i = 1; i < 3; ++i) {
    const int64_t rise = t.v[i][2] - t.v[0][2];
    const Wide plane = Wide{g.dx} * (t.v[i][0] - t.v[0][0]) + Wide{g.dy} * (t.v[i][1] - t.v[0][1]);
    if (plane != Wide{rise} * g.whole) return false;
  }
  return true;
}

bool same_gradient(const microtin_gradient& a, const microtin_gradient& b) {
  return a.dx == b.dx && a.dy == b.dy && a.whole == b.whole;
}

struct GradientCounts {
  int found = 0, none = 0;
};

void check_gradient(microtin_query_result answer, const microtin_gradient& gradient,
                    const Facet* facet, GradientCounts& counts) {
  REQUIRE((answer == MICROTIN_QUERY_OK) == (facet != nullptr));
  ++(facet != nullptr ? counts.found : counts.none);
  if (facet != nullptr) REQUIRE(is_gradient_of(*facet, gradient));
}

}  // namespace

TEST_CASE("the gradient at a position is that of one triangle, the same on a mesh and compact") {
  GradientCounts counts;
  for_each_segment([&](const Both& terrain, const Surface& surface, const microtin_segment& c, bool,
                       Random& random) {
    const int32_t x = static_cast<int32_t>(c.x), y = static_cast<int32_t>(c.y);
    CAPTURE(x);
    CAPTURE(y);
    microtin_gradient gradient = {}, other = {};
    uint32_t hint = random.below(1000), other_hint = random.below(1000);
    const microtin_query_result answer = terrain.mesh.gradient_at(x, y, &hint, &gradient);
    check_gradient(answer, gradient, facet_at(surface, x, y), counts);
    microtin_query_result compact = MICROTIN_QUERY_STEP_LIMIT;
    while (compact == MICROTIN_QUERY_STEP_LIMIT) {
      compact = terrain.compact.gradient_at(x, y, &other_hint, &other, 1);
    }
    REQUIRE(compact == answer);
    if (answer != MICROTIN_QUERY_OK) return;
    REQUIRE(same_gradient(gradient, other));
    uint32_t v[3];
    REQUIRE(microtin_mesh_triangle(terrain.mesh.mesh(), hint, v) == MICROTIN_TRIANGLE_REAL);
    Facet facet;
    for (size_t i = 0; i < 3; ++i) {
      uint16_t vx = 0, vy = 0;
      int16_t vz = 0;
      microtin_mesh_vertex(terrain.mesh.mesh(), v[i], &vx, &vy, &vz);
      facet.v[i] = {vx, vy, vz};
    }
    REQUIRE(is_gradient_of(facet, gradient));
  });
  CHECK(counts.found > 1000);
  CHECK(counts.none > 1000);
}

TEST_CASE_TEMPLATE("pack: the gradient on a border is that of one triangle of its tiles", Device,
                   MeshSlots, CompactSlots) {
  Random random(61);
  GradientCounts counts;
  for (int round = 0; round < 60; ++round) {
    Card card{random_pack(random)};
    const PackFile pack(card.bytes);
    const TileGrid& grid = pack.grid();
    const Device device(9);
    REQUIRE(device.load(card, {0, 0, grid.x_max * 256, 0}) == MICROTIN_STATUS_OK);
    REQUIRE(device.load(card, {0, grid.y_max * 256, grid.x_max * 256, grid.y_max * 256}) ==
            MICROTIN_STATUS_OK);
    const Surface surface = surface_of(pack);
    for (int i = 0; i < 60; ++i) {
      const microtin_segment c = any_segment(random, grid);
      microtin_gradient gradient = {};
      const microtin_query_result answer = device.gradient_at(c.x, c.y, &gradient);
      check_gradient(answer, gradient, facet_at(surface, c.x, c.y), counts);
    }
    microtin_gradient gradient = {};
    CHECK(device.gradient_at(-1, 0, &gradient) == MICROTIN_QUERY_OUTSIDE);
  }
  CHECK(counts.found > 500);
  CHECK(counts.none > 500);
  const Device empty(1);
  microtin_gradient gradient = {};
  CHECK(empty.gradient_at(0, 0, &gradient) == MICROTIN_QUERY_NOT_LOADED);
}

TEST_CASE("a gradient of the largest triangle does not overflow") {
  Tin tin;
  tin.vertices = {{0, 0, -32768}, {65535, 0, 32767}, {0, 65535, 32767}, {65535, 65535, -32768}};
  const DecodedTerrain terrain(encode(tin, Metadata()));
  Surface surface;
  surface.add(terrain.mesh(), 0, 0);
  GradientCounts counts;
  for (const int32_t place : {0, 256, 65535 * 128, 65535 * 256}) {
    uint32_t hint = 0;
    microtin_gradient gradient = {};
    const microtin_query_result answer =
        microtin_mesh_gradient_at(terrain.mesh(), place, place, &hint, &gradient, 0, 0);
    check_gradient(answer, gradient, facet_at(surface, place, place), counts);
  }
  CHECK(counts.found == 4);
}

TEST_CASE("heights at many positions, and the extremes of a grid, are those of single queries") {
  const Both terrain(encode(small_tin(1), Metadata()));
  const microtin_grid_spec grid = {0, 128, 100, 77, 30, 40, -1};
  std::vector<microtin_position> positions;
  std::vector<int32_t> expected;
  int32_t highest = INT32_MIN, lowest = INT32_MAX;
  microtin_query_result answer = MICROTIN_QUERY_OK;
  uint32_t hint = 0;
  for (int32_t row = 0; row < grid.rows; ++row) {
    for (int32_t column = 0; column < grid.columns; ++column) {
      const int32_t x = column * grid.dx, y = 128 + row * grid.dy;
      int32_t height = 0;
      const microtin_query_result here = terrain.mesh.height_at(x, y, &hint, &height);
      if (here == MICROTIN_QUERY_OK) {
        highest = std::max(highest, height);
        lowest = std::min(lowest, height);
      } else {
        answer = here;
      }
      positions.push_back({x, y});
      expected.push_back(here == MICROTIN_QUERY_OK ? height : INT32_MIN);
    }
  }
  REQUIRE(highest > lowest);
  REQUIRE(answer != MICROTIN_QUERY_OK);
  const uint32_t count = static_cast<uint32_t>(positions.size());
  std::vector<int32_t> heights(count), others(count);
  uint32_t other_hint = 0;
  CHECK(terrain.mesh.heights_at(positions.data(), count, &hint, heights.data()) == answer);
  CHECK(heights == expected);
  CHECK(terrain.compact.heights_at(positions.data(), count, &other_hint, others.data()) == answer);
  CHECK(others == expected);
  microtin_grid_extremes found = {0, 0}, other = {0, 0};
  CHECK(terrain.mesh.grid_extremes(grid, &found) == answer);
  CHECK(terrain.compact.grid_extremes(grid, &other) == answer);
  for (const microtin_grid_extremes& extremes : {found, other}) {
    CHECK(extremes.highest == highest);
    CHECK(extremes.lowest == lowest);
  }
}

TEST_CASE_TEMPLATE("pack: heights at many positions, and extremes of grids, are of single queries",
                   Device, MeshSlots, CompactSlots) {
  Card card{pack_bytes(rough_raster(61, 53, void_kinds()[3].at))};
  const Device device(2);
  REQUIRE(device.load(card, at(1, 1)) == MICROTIN_STATUS_OK);
  const microtin_grid_spec grid = {-256, 0, 800, 1300, 20, 10, -1};
  std::vector<microtin_position> positions;
  std::vector<int32_t> expected, heights(200);
  for (int32_t i = 0; i < 200; ++i) {
    positions.push_back({grid.x + i % 20 * grid.dx, grid.y + i / 20 * grid.dy});
    int32_t height = INT32_MIN;
    if (device.height_at(positions.back().x, positions.back().y, height) != MICROTIN_QUERY_OK) {
      height = INT32_MIN;
    }
    expected.push_back(height);
  }
  CHECK(device.heights_at(positions, heights) == MICROTIN_QUERY_NOT_LOADED);
  CHECK(heights == expected);
  microtin_grid_extremes found = {0, 0};
  CHECK(device.grid_extremes(grid, &found) == MICROTIN_QUERY_NOT_LOADED);
  std::vector<int32_t> known;
  for (const int32_t height : expected) {
    if (height != INT32_MIN) known.push_back(height);
  }
  REQUIRE(known.size() > 10);
  CHECK(found.highest == *std::max_element(known.begin(), known.end()));
  CHECK(found.lowest == *std::min_element(known.begin(), known.end()));
}

TEST_CASE("the clearance above a mesh that is not verified is found if the flag allows it") {
  const Bytes stream = terrain_stream(300, 4);
  const Both whole(stream);
  Terrain<kBothCapacity> part;
  Decoder<kBothCapacity> decoder(part);
  size_t used = 0;
  decoder.feed(stream.data(), stream.size() - 1, &used);
  uint16_t x = 0, y = 0;
  int16_t z = 0;
  microtin_mesh_vertex(whole.mesh.mesh(), 9, &x, &y, &z);
  const microtin_path path = {{x * 256, y * 256, x * 256 + 500, y * 256 + 70}, 9999, 0, 0};
  microtin_path_clearance expected, found;
  CHECK(part.path_clearance(path, &found) == MICROTIN_QUERY_UNVERIFIED);
  REQUIRE(whole.mesh.path_clearance(path, &expected) == MICROTIN_QUERY_OK);
  REQUIRE(part.path_clearance(path, &found, MICROTIN_FLAG_ALLOW_UNVERIFIED) == MICROTIN_QUERY_OK);
  CHECK(found.least == expected.least);
  CHECK(found.first_along == expected.first_along);
}

}  // namespace microtin::tests
