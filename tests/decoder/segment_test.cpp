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
#include "tests/support/limited_segment.hpp"
#include "tests/support/reference_segment.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {
namespace {

using namespace reference;

constexpr uint32_t kCapacity = 400;

// A terrain twice: as a mesh, and compact.
struct Both {
  Terrain<kCapacity> mesh, made;
  CompactTerrain<kCapacity> compact;

  explicit Both(const Bytes& stream) {
    Decoder<kCapacity> decoder(mesh);
    size_t used = 0;
    REQUIRE(decoder.feed(stream.data(), stream.size(), &used) == MICROTIN_STATUS_OK);
    decoder.begin(made);
    REQUIRE(decoder.feed(stream.data(), stream.size(), &used) == MICROTIN_STATUS_OK);
    REQUIRE(compact.make(made, decoder) == MICROTIN_STATUS_OK);
  }
};

struct Counts {
  int known = 0, in_void = 0, outside = 0;
};

microtin_query_result answer_at(const Both& terrain, int64_t x, int64_t y, int32_t* height) {
  uint32_t hint = 0;
  return terrain.mesh.height_at(static_cast<int32_t>(x), static_cast<int32_t>(y), &hint, height);
}

// Both forms say the same in calls of any length, of one step, and of all that are left.
void check_in_pieces(const Both& terrain, const microtin_segment& c, const Highest& highest) {
  Random random(static_cast<uint64_t>(c.x + c.y_end));
  for (const uint32_t most : {1u, 7u, 200u}) {
    REQUIRE(highest_in_pieces(terrain.mesh.mesh(), c, most, random) == highest);
    REQUIRE(highest_in_pieces(terrain.compact.compact(), c, most, random) == highest);
  }
  microtin_segment_state mesh = {}, compact = {};
  int32_t height = 0;
  REQUIRE(terrain.mesh.segment_max(c, &mesh, &height, 5) != MICROTIN_QUERY_OK);
  REQUIRE(terrain.mesh.segment_max(c, &mesh, &height, 0) == highest.answer);
  REQUIRE(height == highest.height);
  terrain.compact.segment_max(c, &compact, &height, 5);
  REQUIRE(terrain.compact.segment_max(c, &compact, &height, 0) == highest.answer);
  REQUIRE(height == highest.height);
}

void check_segment(const Both& terrain, const Surface& surface, const microtin_segment& c,
                   Counts& counts) {
  CAPTURE(c.x);
  CAPTURE(c.y);
  CAPTURE(c.x_end);
  CAPTURE(c.y_end);
  const Expected expected = expect(surface, c);
  int32_t highest = 1, compact_highest = 2, begin = INT32_MIN, end = INT32_MIN;
  const microtin_query_result answer = terrain.mesh.segment_max(c, &highest);
  REQUIRE(terrain.compact.segment_max(c, &compact_highest) == answer);
  REQUIRE(compact_highest == highest);
  REQUIRE(highest == expected.highest);
  REQUIRE((answer == MICROTIN_QUERY_OK) == expected.is_known);
  check_in_pieces(terrain, c, {answer, highest});
  const bool leaves = answer_at(terrain, c.x, c.y, &begin) == MICROTIN_QUERY_OUTSIDE ||
                      answer_at(terrain, c.x_end, c.y_end, &end) == MICROTIN_QUERY_OUTSIDE;
  REQUIRE((answer == MICROTIN_QUERY_OUTSIDE) == leaves);
  ++(expected.is_known ? counts.known : leaves ? counts.outside : counts.in_void);
}

Tin small_tin(uint32_t seed) {
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

// Whole steps at times, along an axis at times; now and then beside the terrain.
microtin_segment small_segment(Random& random, int64_t side) {
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

}  // namespace

TEST_CASE("the highest on a segment of a terrain is exact, and known if every place is") {
  Counts counts;
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

TEST_CASE("the highest of segments with an end off the lattice, and of meshes that are not there") {
  const Both terrain(terrain_stream(300, 4));
  uint16_t column = 0, row = 0;
  int16_t z = 0;
  microtin_mesh_vertex(terrain.mesh.mesh(), 0, &column, &row, &z);
  const int64_t x = int64_t{column} * 256, y = int64_t{row} * 256;
  int32_t height = 1;
  REQUIRE(answer_at(terrain, x, y, &height) == MICROTIN_QUERY_OK);
  for (const microtin_segment& c :
       {microtin_segment{-1, 0, 5000, 0}, microtin_segment{x, y, 65535 * 256 + 1, y},
        microtin_segment{INT64_MIN, 0, INT64_MAX, 0},
        microtin_segment{0, INT64_MAX, 0, INT64_MIN}}) {
    CHECK(terrain.mesh.segment_max(c, &height) == MICROTIN_QUERY_OUTSIDE);
    CHECK(height == INT32_MIN);
    CHECK(terrain.compact.segment_max(c, &height) == MICROTIN_QUERY_OUTSIDE);
  }
  CHECK(terrain.made.segment_max({0, 0, 5, 5}, &height) == MICROTIN_QUERY_NOT_LOADED);
  const Bytes stream = terrain_stream(900, 6);
  const Device device(900);
  size_t used = 0;
  REQUIRE(device.feed(stream.data(), stream.size(), &used, 300) == MICROTIN_STATUS_STEP_LIMIT);
  const microtin_segment c = {0, 0, 65535 * 256, 65535 * 256};
  CHECK(microtin_mesh_segment_max(device.mesh, &c, nullptr, &height, 0) ==
        MICROTIN_QUERY_UNVERIFIED);
  microtin_segment_state progress = {};
  CHECK(microtin_mesh_segment_max(device.mesh, &c, &progress, &height, 9) ==
        MICROTIN_QUERY_UNVERIFIED);
  CHECK(progress.next == 0);
}

TEST_CASE("a segment goes on where it was left, and an older progress stays in the terrain") {
  const Both large(terrain_stream(300, 4)), small(terrain_stream(20, 5));
  const microtin_segment c = {0, 0, 65535 * 256, 65535 * 256}, off = {-1, 0, 0, 0};
  for (uint32_t next = 0; next < triangles_of(large.mesh.mesh()) + 4; ++next) {
    microtin_segment_state progress = {next, UINT32_MAX, 0, MICROTIN_QUERY_OK}, other = progress;
    for (uint32_t i = 0; i < 3; ++i) {
      const uint32_t before = progress.next;
      limited_highest(small.mesh.mesh(), c, 2, &progress);
      limited_highest(small.compact.compact(), c, 2, &other);
      CHECK(progress.next - before <= 2);
    }
    const uint32_t end = triangles_of(small.mesh.mesh()) + 2;
    if (next > end) CHECK(progress.next == next);
    CHECK(limited_highest(small.mesh.mesh(), off, 1, &progress).answer == MICROTIN_QUERY_OUTSIDE);
  }
  microtin_segment_state most = {UINT32_MAX, 0, 7, MICROTIN_QUERY_VOID};
  CHECK(limited_highest(large.mesh.mesh(), c, 1, &most) == Highest{MICROTIN_QUERY_VOID, 7});
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
