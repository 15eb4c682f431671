// SPDX-License-Identifier: MIT
// Segments and blocks on a single terrain, as a mesh and in compact form: against exact fractions.
#include "microtin/segment.h"

#include <doctest/doctest.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "microtin/microtin.hpp"
#include "tests/support/compact_pair.hpp"
#include "tests/support/device.hpp"
#include "tests/support/forged_pack.hpp"
#include "tests/support/limited_segment.hpp"
#include "tests/support/reference_segment.hpp"
#include "tests/support/segment_terrains.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {
namespace {

using namespace reference;

struct SegmentCounts {
  int known = 0, in_void = 0, outside = 0;
};

microtin_query_result answer_at(const Both& terrain, int64_t x, int64_t y, int32_t* height) {
  uint32_t hint = 0;
  return terrain.mesh.height_at(static_cast<int32_t>(x), static_cast<int32_t>(y), &hint, height);
}

// Both forms say the same in calls of any length, of one step, and of all that are left.
void check_in_pieces(const Both& terrain, const microtin_segment& c, const Extremes& extremes) {
  Random random(static_cast<uint64_t>(c.x + c.y_end));
  for (const uint32_t most : {1u, 7u, 200u}) {
    REQUIRE(extremes_in_pieces(terrain.mesh.mesh(), c, most, random) == extremes);
    REQUIRE(extremes_in_pieces(terrain.compact.compact(), c, most, random) == extremes);
  }
  microtin_segment_state mesh = {}, compact = {};
  limited_extremes(terrain.mesh.mesh(), c, 1, &mesh);
  REQUIRE(limited_extremes(terrain.mesh.mesh(), c, 0, &mesh) == extremes);
  limited_extremes(terrain.compact.compact(), c, 2, &compact);
  REQUIRE(limited_extremes(terrain.compact.compact(), c, 0, &compact) == extremes);
}

void check_segment(const Both& terrain, const Surface& surface, const microtin_segment& c,
                   SegmentCounts& counts) {
  CAPTURE(c.x);
  CAPTURE(c.y);
  CAPTURE(c.x_end);
  CAPTURE(c.y_end);
  const Expected expected = expect(surface, c);
  int32_t begin = INT32_MIN, end = INT32_MIN;
  const Extremes extremes = extremes_on(terrain.mesh.mesh(), c);
  const microtin_query_result answer = extremes.answer;
  REQUIRE(extremes.found.highest == expected.highest());
  REQUIRE(extremes.found.lowest == expected.lowest());
  REQUIRE(extremes.found.highest_along == expected.first_along(expected.highest()));
  REQUIRE(extremes.found.lowest_along == expected.first_along(expected.lowest()));
  REQUIRE((answer == MICROTIN_QUERY_OK) == expected.is_known);
  REQUIRE(extremes_on(terrain.compact.compact(), c) == extremes);
  check_in_pieces(terrain, c, extremes);
  const bool leaves = answer_at(terrain, c.x, c.y, &begin) == MICROTIN_QUERY_OUTSIDE ||
                      answer_at(terrain, c.x_end, c.y_end, &end) == MICROTIN_QUERY_OUTSIDE;
  REQUIRE((answer == MICROTIN_QUERY_OUTSIDE) == leaves);
  ++(expected.is_known ? counts.known : leaves ? counts.outside : counts.in_void);
}

}  // namespace

TEST_CASE("the extremes on a segment are exact on tiny terrains, where lines meet vertices") {
  SegmentCounts counts;
  for (uint32_t seed = 0; seed < 150; ++seed) {
    CAPTURE(seed);
    const Both terrain(encode(tiny_tin(seed), Metadata(), Effort{32, Coding::kQuick}));
    Surface surface;
    surface.add(terrain.mesh.mesh(), 0, 0);
    Random random(seed);
    for (int i = 0; i < 200; ++i) check_segment(terrain, surface, tiny_segment(random), counts);
  }
  CHECK(counts.known > 500);
  CHECK(counts.in_void > 500);
  CHECK(counts.outside > 500);
}

TEST_CASE("the extremes on a segment of a terrain are exact, and known if every place is") {
  SegmentCounts counts;
  for (uint32_t seed = 0; seed < 160; ++seed) {
    CAPTURE(seed);
    const Both terrain(encode(small_tin(seed), Metadata(), Effort{32, Coding::kQuick}));
    Surface surface;
    surface.add(terrain.mesh.mesh(), 0, 0);
    Random random(seed);
    for (int i = 0; i < 60; ++i) check_segment(terrain, surface, small_segment(random, 27), counts);
  }
  CHECK(counts.known > 500);
  CHECK(counts.in_void > 500);
  CHECK(counts.outside > 500);
}

TEST_CASE("the lowest height that there can be, which is the number for none, is a height") {
  Tin tin;
  tin.vertices = {{0, 0, INT16_MIN}, {4, 0, INT16_MIN}, {0, 4, INT16_MIN}, {4, 4, INT16_MIN}};
  const Both flat(encode(tin, Metadata()));
  const microtin_segment through = {0, 0, 1024, 512}, place = {512, 512, 512, 512};
  for (const microtin_segment& c : {through, place}) {
    const Extremes expected{MICROTIN_QUERY_OK, {INT32_MIN, INT32_MIN, 0, 0}};
    CHECK(extremes_on(flat.mesh.mesh(), c) == expected);
    CHECK(extremes_on(flat.compact.compact(), c) == expected);
  }
  const Extremes late{MICROTIN_QUERY_OUTSIDE, {INT32_MIN, INT32_MIN, 1 << 29, 1 << 29}};
  tin.vertices[0].x = 2;
  CHECK(extremes_on(Both(encode(tin, Metadata())).mesh.mesh(), {0, 0, 1024, 0}) == late);
}

TEST_CASE(
    "the extremes of segments with an end off the lattice, and of meshes that are not there") {
  const Both terrain(terrain_stream(300, 4));
  uint16_t column = 0, row = 0;
  int16_t z = 0;
  microtin_mesh_vertex(terrain.mesh.mesh(), 0, &column, &row, &z);
  const int64_t x = int64_t{column} * 256, y = int64_t{row} * 256;
  int32_t height = 1;
  REQUIRE(answer_at(terrain, x, y, &height) == MICROTIN_QUERY_OK);
  const Extremes outside{MICROTIN_QUERY_OUTSIDE, {INT32_MIN, INT32_MAX, 0, 0}};
  for (const microtin_segment& c :
       {microtin_segment{-1, 0, 5000, 0}, microtin_segment{x, y, 65535 * 256 + 1, y},
        microtin_segment{INT64_MIN, 0, INT64_MAX, 0},
        microtin_segment{0, INT64_MAX, 0, INT64_MIN}}) {
    CHECK(extremes_on(terrain.mesh.mesh(), c) == outside);
    CHECK(extremes_on(terrain.compact.compact(), c) == outside);
  }
  microtin_segment_extremes found;
  CHECK(terrain.made.segment_extremes({0, 0, 5, 5}, &found) == MICROTIN_QUERY_NOT_LOADED);
  const Bytes stream = terrain_stream(900, 6);
  const Device device(900);
  size_t used = 0;
  REQUIRE(device.feed(stream.data(), stream.size(), &used, 300) == MICROTIN_STATUS_STEP_LIMIT);
  const microtin_segment c = {0, 0, 65535 * 256, 65535 * 256};
  CHECK(extremes_on(device.mesh, c).answer == MICROTIN_QUERY_UNVERIFIED);
  microtin_segment_state state = {};
  CHECK(limited_extremes(device.mesh, c, 9, &state).answer == MICROTIN_QUERY_UNVERIFIED);
  CHECK(state.stage == 0);
}

// Whatever a state says: calls end, and stay in the terrain, as sanitizers see.
template <class Form>
void check_any_state(const Form* form, const microtin_segment& c, microtin_segment_state state) {
  for (uint32_t i = 0; i < 3; ++i) limited_extremes(form, c, 2, &state);
  CHECK(limited_extremes(form, c, 0, &state).answer != MICROTIN_QUERY_STEP_LIMIT);
}

TEST_CASE("a segment goes on where it was left, and a state of another one stays in the terrain") {
  const Both large(terrain_stream(300, 4)), small(terrain_stream(20, 5));
  const microtin_segment off = {-1, 0, 0, 0};
  Random random(5);
  for (uint32_t stage = 0; stage < 9; ++stage) {
    for (uint32_t triangle = 0; triangle < triangles_of(large.mesh.mesh()); ++triangle) {
      const microtin_segment c = segment_near(small.mesh.mesh(), random);
      const microtin_segment_state state = {stage, triangle, 0, 0, {7, 6}, {5, 4}, {3, 0}};
      check_any_state(small.mesh.mesh(), c, state);
      check_any_state(small.compact.compact(), c, state);
    }
    microtin_segment_state state = {stage, 0, 0, 0, {7, 6}, {5, 4}, {3, 0}};
    CHECK(limited_extremes(small.mesh.mesh(), off, 1, &state).answer == MICROTIN_QUERY_OUTSIDE);
  }
  const microtin_segment c = {0, 0, 65535 * 256, 65535 * 256};
  microtin_segment_state most = {UINT32_MAX, 0, MICROTIN_QUERY_VOID, 0, {7, 6}, {0, 1}, {1, 1}};
  CHECK(limited_extremes(large.mesh.mesh(), c, 1, &most) ==
        Extremes{MICROTIN_QUERY_VOID, {7, 6, 0, 1 << 30}});
}

TEST_CASE("blocks of a terrain contain the heights of single queries, in whole units") {
  Metadata metadata;
  metadata.placement.z = {-7, 3, 4};
  const Both terrain(encode(small_tin(7), metadata, Effort{32, Coding::kQuick}));
  const microtin_grid_spec block = {-100, 100, 80, 150, 40, 20, -9999};
  std::array<int16_t, 800> heights{}, others{};
  const microtin_query_result answer = terrain.mesh.sample_grid(block, heights.data());
  CHECK(terrain.compact.sample_grid(block, others.data()) == answer);
  CHECK(heights == others);
  microtin_query_result last = MICROTIN_QUERY_OK;
  int known = 0;
  for (int i = 0; i < 800; ++i) {
    int32_t z = 0;
    const microtin_query_result here =
        answer_at(terrain, block.x + i % 40 * block.dx, block.y + i / 40 * block.dy, &z);
    if (here != MICROTIN_QUERY_OK) last = here;
    known += here == MICROTIN_QUERY_OK ? 1 : 0;
    const Wide real = rounded((Wide{z} * 3 - Wide{7} * 65536), Wide{4} * 65536);
    CHECK(heights[static_cast<size_t>(i)] == (here == MICROTIN_QUERY_OK ? real : -9999));
  }
  CHECK(answer == last);
  CHECK(known > 150);
  CHECK(known < 800);
  CHECK(terrain.compact.sample_grid({INT64_MAX, 0, 1, 1, 1, 1, 0}, others.data()) ==
        MICROTIN_QUERY_OUTSIDE);
}

}  // namespace microtin::tests
