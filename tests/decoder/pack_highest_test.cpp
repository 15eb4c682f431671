// SPDX-License-Identifier: MIT
// The extremes on a segment: against exact fractions, on packs of the encoder and on forged ones.
#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "tests/support/forged_pack.hpp"
#include "tests/support/limited_segment.hpp"
#include "tests/support/pack_device.hpp"
#include "tests/support/pack_segments.hpp"
#include "tests/support/packs.hpp"
#include "tests/support/reference_segment.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/slow.hpp"

namespace microtin::tests {
namespace {

using namespace reference;

struct HighestCounts {
  int known = 0, unknown = 0;
};

// A single place where tiles disagree has any of their heights.
void check_extremes(const Expected& expected, const microtin_segment_extremes& found,
                    bool is_exact) {
  if (expected.meetings.empty()) {
    REQUIRE(found.highest == INT32_MIN);
    REQUIRE(found.lowest == INT32_MAX);
    return;
  }
  REQUIRE(expected.has(found.highest, found.highest_along));
  REQUIRE(expected.has(found.lowest, found.lowest_along));
  if (!is_exact) return;
  REQUIRE(found.highest == expected.highest());
  REQUIRE(found.lowest == expected.lowest());
}

// The answer on a segment is that of exact fractions, and those at places on it agree.
void check_segment(const PackDevice& device, const Surface& surface, const microtin_segment& c,
                   bool tiles_agree, HighestCounts& counts) {
  CAPTURE(c.x);
  CAPTURE(c.y);
  CAPTURE(c.x_end);
  CAPTURE(c.y_end);
  microtin_segment_extremes found = {1, 1, 1, 1};
  const microtin_query_result answer = device.segment_extremes(c, &found);
  const Expected expected = expect(surface, c);
  REQUIRE(answer == (expected.is_known ? MICROTIN_QUERY_OK : MICROTIN_QUERY_VOID));
  check_extremes(expected, found, tiles_agree || (c.x != c.x_end || c.y != c.y_end));
  ++(expected.is_known ? counts.known : counts.unknown);
  for (int64_t k = 0; k <= 64; ++k) {
    const int64_t dx = (c.x_end - c.x) * k, dy = (c.y_end - c.y) * k;
    if (dx % 64 != 0 || dy % 64 != 0) continue;
    int32_t height = INT32_MIN;
    const microtin_query_result here = device.height_at(c.x + dx / 64, c.y + dy / 64, height);
    REQUIRE((here == MICROTIN_QUERY_OK || here == MICROTIN_QUERY_VOID));
    if (here == MICROTIN_QUERY_VOID) REQUIRE(answer == MICROTIN_QUERY_VOID);
    if (tiles_agree) REQUIRE(height <= found.highest);
  }
}

template <class Device>
void check_pack(const Bytes& bytes, Random& random, int segments, bool tiles_agree,
                HighestCounts& counts) {
  Card card{bytes};
  const PackFile pack(bytes);
  const Surface surface = surface_of(pack);
  const TileGrid& grid = pack.grid();
  const Device device(static_cast<uint32_t>(pack.entries().size()),
                      std::max(3u, pack.header().most_vertices));
  for (uint32_t tile = 0; tile < pack.entries().size(); ++tile) {
    const TileBox box = tile_box(grid, tile);
    REQUIRE(device.load(card, at(box.x, box.y)) == MICROTIN_STATUS_OK);
    REQUIRE(device.load(card, at(box.x_end, box.y_end)) == MICROTIN_STATUS_OK);
  }
  for (int i = 0; i < segments; ++i) {
    check_segment(device, surface, any_segment(random, grid), tiles_agree, counts);
  }
}

// Heights that a lattice of posts has, but for a void post in the middle.
Raster ring_of_posts() {
  Raster raster;
  raster.width = raster.height = 9;
  for (int64_t y = 0; y < 9; ++y) {
    for (int64_t x = 0; x < 9; ++x) {
      raster.heights.push_back(x == 4 && y == 4 ? kVoidHeight : (3 * x + 5 * y) % 7);
    }
  }
  return raster;
}

uint32_t repeats_of(const Tin& tin) {
  return compact_form(DecodedTerrain(encode(tin, Metadata()))).repeats;
}

// A tile of which the path of the compact form misses some vertices, found by moving one after
// another; some of its triangles are void.
Tin missed_tile(Random& random, uint16_t side) {
  Tin best = random_tile(random, side, side, false, 0);
  uint32_t most = repeats_of(best);
  for (int i = 0; i < 150; ++i) {
    Tin tin = best;
    Vertex& moved = tin.vertices[random.below(static_cast<uint32_t>(tin.vertices.size()))];
    moved.x = static_cast<uint16_t>(random.below(side + 1u));
    moved.y = static_cast<uint16_t>(random.below(side + 1u));
    const auto meets = [&](const Vertex& v) {
      return &v != &moved && v.x == moved.x && v.y == moved.y;
    };
    if (std::any_of(tin.vertices.begin(), tin.vertices.end(), meets) || !has_triangle(tin))
      continue;
    const uint32_t repeats = repeats_of(tin);
    if (repeats >= most) best = tin;
    most = std::max(most, repeats);
  }
  return with_some_voids(std::move(best), random, 30);
}

}  // namespace

TEST_CASE_TEMPLATE(
    "pack: the extremes on a segment are exact, and known if every place is, on forged tiles",
    Device, MeshSlots, CompactSlots) {
  Random random(31);
  HighestCounts counts;
  for (int round = 0; round < 150; ++round) {
    check_pack<Device>(random_pack(random), random, 60, false, counts);
  }
  CHECK(counts.known > 1000);
  CHECK(counts.unknown > 1000);
}

TEST_CASE_TEMPLATE(
    "pack: the extremes on a segment are exact, and known if every place is, on encoded tiles" *
        kSlow,
    Device, MeshSlots, CompactSlots) {
  Random random(32);
  HighestCounts counts;
  for (const VoidKind& kind : void_kinds()) {
    CAPTURE(kind.name);
    const Raster raster = rough_raster(61, 53, kind.at);
    check_pack<Device>(write_pack(encode_pack(raster, pack_options(3, 100))), random, tried(40),
                       true, counts);
  }
  CHECK(counts.known > tried(100));
  CHECK(counts.unknown > tried(100));
}

TEST_CASE_TEMPLATE("pack: the extremes on a segment are exact where compact paths miss vertices" *
                       kSlow,
                   Device, MeshSlots, CompactSlots) {
  Random random(35);
  HighestCounts counts;
  uint32_t repeats = 0;
  for (int round = 0; round < 60; ++round) {
    const uint16_t side = static_cast<uint16_t>(5 + random.below(4));
    std::vector<ForgedTile> tiles;
    for (int i = 0; i < 2; ++i) {
      const Tin tin = missed_tile(random, side);
      repeats += repeats_of(tin);
      tiles.push_back(forged_tile(tin));
    }
    check_pack<Device>(forged_pack({2u * side, side, side, side}, tiles), random, 100, false,
                       counts);
  }
  CHECK(repeats > 100);
  CHECK(counts.known > 100);
  CHECK(counts.unknown > 100);
}

TEST_CASE_TEMPLATE(
    "pack: an edge between voids is no height, touching a tile without terrain is no void", Device,
    MeshSlots, CompactSlots) {
  Random random(33);
  HighestCounts counts;
  PackOptions options = pack_options(0, 100);
  check_pack<Device>(write_pack(encode_pack(ring_of_posts(), options)), random, 400, true, counts);
  const TileGrid grid = {8, 4, 4, 4};
  const ForgedTile square = forged_tile({{{0, 0, 1}, {4, 0, 2}, {0, 4, 3}, {4, 4, 4}}, {}});
  Card card{forged_pack(grid, {square, {}})};
  const Device device(2);
  REQUIRE(device.load(card, {0, 0, 2047, 0}) == MICROTIN_STATUS_OK);
  int32_t highest = 0;
  const auto answer = [&](const microtin_segment& c) { return device.highest_on(c, &highest); };
  CHECK(answer({1024, 100, 1024, 100}) == MICROTIN_QUERY_OK);  // a place on the border
  CHECK(answer({1024, 0, 1024, 1024}) == MICROTIN_QUERY_OK);   // along it
  CHECK(highest == 4 * 65536);
  CHECK(answer({0, 512, 1024, 512}) == MICROTIN_QUERY_OK);    // up to it
  CHECK(answer({0, 512, 1025, 512}) == MICROTIN_QUERY_VOID);  // a 256th of a step too far
}

TEST_CASE_TEMPLATE("pack: a segment through tiles that are not there has the extremes of the rest",
                   Device, MeshSlots, CompactSlots) {
  const TileGrid grid = {8, 4, 4, 4};
  const ForgedTile low = forged_tile({{{0, 0, 1}, {4, 0, 2}, {0, 4, 3}, {4, 4, 4}}, {}}),
                   high = forged_tile({{{0, 0, 2}, {4, 0, 9}, {0, 4, 4}, {4, 4, 9}}, {}});
  Card card{forged_pack(grid, {low, high})};
  const Device device(1);
  const microtin_segment c = {0, 0, 8 * 256, 0};
  microtin_segment_extremes found;
  CHECK(device.segment_extremes(c, &found) == MICROTIN_QUERY_NOT_LOADED);
  REQUIRE(device.load(card, at(1, 0)) == MICROTIN_STATUS_OK);
  CHECK(device.segment_extremes(c, &found) == MICROTIN_QUERY_NOT_LOADED);
  CHECK(same(found, {2 * 65536, 65536, 1 << 29, 0}));
  REQUIRE(device.load(card, at(7, 0)) == MICROTIN_STATUS_OK);
  CHECK(device.segment_extremes(c, &found) == MICROTIN_QUERY_NOT_LOADED);
  CHECK(same(found, {9 * 65536, 2 * 65536, 1 << 30, 1 << 29}));
  CHECK(device.segment_extremes({0, 0, INT64_C(1) << 24, 0}, &found) == MICROTIN_QUERY_OUTSIDE);
  CHECK(same(found, {INT32_MIN, INT32_MAX, 0, 0}));
}

TEST_CASE_TEMPLATE("pack: heights where a segment leaves the terrain are rounded once, halves up",
                   Device, MeshSlots, CompactSlots) {
  // A hull edge of 512 steps, seen from one side alone: at odd places of it heights end in a half.
  for (const int rise : {-1, 1, -3, 3}) {
    const int16_t low = static_cast<int16_t>(rise < 0 ? -rise : 0),
                  high = static_cast<int16_t>(low + rise);
    const Tin tin{{{256, 0, low}, {256, 512, high}, {0, 0, -5}, {0, 512, -5}}, {}};
    Card card{forged_pack({512, 512, 512, 512}, {forged_tile(tin)})};
    const Device device(1);
    REQUIRE(device.load(card, at(1, 1)) == MICROTIN_STATUS_OK);
    const Surface surface = surface_of(PackFile(card.bytes));
    HighestCounts counts;
    for (int64_t y = 1; y < 512 * 256; y += 998) {
      check_segment(device, surface, {0, y, 512 * 256, y}, true, counts);
    }
    CHECK(counts.unknown > 100);
  }
}

TEST_CASE_TEMPLATE(
    "pack: the extremes on the longest segments and the largest tiles does not overflow", Device,
    MeshSlots, CompactSlots) {
  const TileGrid grid = {2 * 65535, 65535, 65535, 65535};
  const auto corner = [](uint16_t x, uint16_t y, bool high) {
    return Vertex{x, y, static_cast<int16_t>(high ? 32767 : -32768)};
  };
  Random random(34);
  for (int round = 0; round < 40; ++round) {
    std::vector<ForgedTile> tiles;
    for (int i = 0; i < 2; ++i) {
      const auto shy = [&] { return static_cast<uint16_t>(random.below(2) * random.below(3)); };
      const uint16_t a = shy(), b = shy(), c = shy(), d = shy();
      Tin tin{{corner(a, b, false), corner(static_cast<uint16_t>(65535 - c), a, true),
               corner(b, static_cast<uint16_t>(65535 - d), true),
               corner(static_cast<uint16_t>(65535 - d), static_cast<uint16_t>(65535 - c), false)},
              {}};
      tiles.push_back(forged_tile(tin));
    }
    Card card{forged_pack(grid, tiles)};
    const Device device(2);
    REQUIRE(device.load(card, at(65535, 7)) == MICROTIN_STATUS_OK);
    const Surface surface = surface_of(PackFile(card.bytes));
    for (int i = 0; i < 60; ++i) {
      const auto pick = [&](int64_t most) {
        const int64_t inside = static_cast<int64_t>(random.next() % static_cast<uint64_t>(most));
        const int64_t edge = random.below(2) * most;
        return random.below(2) == 0 ? inside
                                    : std::abs(edge - static_cast<int64_t>(random.below(1000)));
      };
      const int64_t x = pick(2 * 65535 * 256), y = pick(65535 * 256);
      const int64_t x_end =
          std::clamp<int64_t>(pick(2 * 65535 * 256), x - 65535 * 256 + 1, x + 65535 * 256 - 1);
      const microtin_segment c = {x, y, std::min<int64_t>(x_end, 2 * 65535 * 256),
                                  pick(65535 * 256 - 1)};
      int32_t highest = 0;
      const microtin_query_result answer = device.highest_on(c, &highest);
      // Heights of the reference would overflow: whether all is known alone.
      std::vector<Stretch> stretches = stretches_of(surface, c);
      CHECK(answer == (cover(stretches) ? MICROTIN_QUERY_OK : MICROTIN_QUERY_VOID));
    }
  }
}

}  // namespace microtin::tests
