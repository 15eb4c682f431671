// SPDX-License-Identifier: MIT
// The clearance of paths above meshes, compact terrains and packs: against exact fractions.
#include <doctest/doctest.h>

#include <algorithm>

#include "decoder/ring.hpp"
#include "decoder/touched_tiles.hpp"
#include "tests/support/limited_segment.hpp"
#include "tests/support/pack_device.hpp"
#include "tests/support/packs.hpp"
#include "tests/support/reference_clearance.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/segment_terrains.hpp"
#include "tests/support/slow.hpp"

namespace microtin::tests {
namespace {

using namespace reference;

bool operator==(const microtin_path_clearance& a, const microtin_path_clearance& b) {
  return a.least == b.least && a.least_along == b.least_along && a.first_along == b.first_along;
}

constexpr microtin_path_clearance kNothing = {INT32_MAX, 0, -1};

// Calls of few steps have the same result.
template <class Form>
void check_in_pieces(const Form* form, const microtin_path& path, microtin_query_result answer,
                     const microtin_path_clearance& clearance) {
  microtin_segment_state state = {};
  microtin_path_clearance found;
  for (uint32_t i = 0; i < 3 * triangles_of(form); ++i) {
    if (limited_clearance(form, path, &state, &found, 1) != MICROTIN_QUERY_STEP_LIMIT) break;
    REQUIRE(found == kNothing);
  }
  REQUIRE(limited_clearance(form, path, &state, &found, 2) == answer);
  REQUIRE(found == clearance);
}

// Near the terrain, whose heights reach as far: level, climbing, or a line from place to place.
microtin_path path_over(const microtin_segment& segment, int32_t most, Random& random) {
  const auto pick = [&](int32_t reach) {
    const uint32_t width = static_cast<uint32_t>(2 * reach + 1);
    return static_cast<int32_t>(random.below(width)) - reach;
  };
  microtin_path path = {segment, pick(most * 256), pick(most * 256), pick(most * 64)};
  if (random.below(3) == 0) path.z_end = path.z;
  if (random.below(4) == 0) path.clearance = 0;
  if (random.below(4) == 0) path.z = path.z / 256 * 256, path.z_end = path.z_end / 256 * 256;
  return path;
}

struct ClearanceCounts {
  int clear = 0, low = 0, at_begin = 0;

  void add(const microtin_path_clearance& found) {
    ++(found.first_along < 0 ? clear : found.first_along == 0 ? at_begin : low);
  }
};

void check_path(const Both& terrain, const Surface& surface, const microtin_path& path,
                ClearanceCounts& counts) {
  CAPTURE(path.segment.x);
  CAPTURE(path.segment.y);
  CAPTURE(path.segment.x_end);
  CAPTURE(path.segment.y_end);
  CAPTURE(path.z);
  CAPTURE(path.z_end);
  CAPTURE(path.clearance);
  microtin_path_clearance found, compact;
  const microtin_query_result answer = terrain.mesh.path_clearance(path, &found);
  CAPTURE(found.least);
  CAPTURE(found.first_along);
  REQUIRE(clearance_fault(surface, path, 0, found) == "");
  REQUIRE(answer == extremes_on(terrain.mesh.mesh(), path.segment).answer);
  REQUIRE(terrain.compact.path_clearance(path, &compact) == answer);
  REQUIRE(compact == found);
  check_in_pieces(terrain.mesh.mesh(), path, answer, found);
  check_in_pieces(terrain.compact.compact(), path, answer, found);
  counts.add(found);
}

}  // namespace

TEST_CASE("the clearance of a path above a terrain is exact, and its first low place") {
  ClearanceCounts counts;
  for_each_segment([&](const Both& terrain, const Surface& surface, const microtin_segment& c,
                       bool is_tiny, Random& random) {
    check_path(terrain, surface, path_over(c, is_tiny ? 5 : 1100, random), counts);
  });
  CHECK(counts.clear > 500);
  CHECK(counts.low > 500);
  CHECK(counts.at_begin > 500);
}

TEST_CASE("the clearance of paths that are not legal, and of terrains without margins") {
  const Both terrain(terrain_stream(300, 4));
  const microtin_segment c = {0, 0, 65535 * 256, 65535 * 256};
  const int32_t most = 1 << 25;
  microtin_path_clearance found;
  for (const microtin_path& path :
       {microtin_path{c, most + 1, 0, 0}, microtin_path{c, 0, INT32_MIN, 0},
        microtin_path{c, 0, 0, INT32_MAX}, microtin_path{{-1, 0, 5, 5}, 0, 0, 0}}) {
    CHECK(terrain.mesh.path_clearance(path, &found) == MICROTIN_QUERY_OUTSIDE);
    CHECK(found == kNothing);
    CHECK(terrain.compact.path_clearance(path, &found) == MICROTIN_QUERY_OUTSIDE);
  }
  const microtin_path path = {c, -most, -most, most};
  CHECK(terrain.mesh.path_clearance(path, &found) == MICROTIN_QUERY_OUTSIDE);
  CHECK(found.least < 0);
  CHECK(terrain.mesh.path_clearance(path, &found, MICROTIN_FLAG_SAFE) == MICROTIN_QUERY_NO_MARGIN);
  CHECK(terrain.compact.path_clearance(path, &found, MICROTIN_FLAG_SAFE) ==
        MICROTIN_QUERY_NO_MARGIN);
  CHECK(found == kNothing);
  CHECK(terrain.made.path_clearance(path, &found) == MICROTIN_QUERY_NOT_LOADED);
}

TEST_CASE("the clearance above what the source can be is lower by the margin") {
  Both terrain(encode(small_tin(3), Metadata(), Effort{32, Coding::kQuick}));
  const uint32_t below = 37;
  terrain.mesh.mesh()->below = below;
  const_cast<microtin_compact*>(terrain.compact.compact())->below = below;
  Surface surface;
  surface.add(terrain.mesh.mesh(), 0, 0);
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const microtin_path path = path_over(small_segment(random, 27), 1100, random);
    microtin_path_clearance found, compact;
    const microtin_query_result answer =
        terrain.mesh.path_clearance(path, &found, MICROTIN_FLAG_SAFE);
    REQUIRE(clearance_fault(surface, path, below * 16, found) == "");
    CHECK(terrain.compact.path_clearance(path, &compact, MICROTIN_FLAG_SAFE) == answer);
    CHECK(compact == found);
  }
}

// In a pack each tile has a margin of its own, at most that of the header.
void check_safe(const PackDevice& device, const microtin_path& path,
                const microtin_path_clearance& surface) {
  microtin_path_clearance safe;
  microtin_pack_info info;
  REQUIRE(microtin_pack_get_info(device.pack, &info) == MICROTIN_STATUS_OK);
  REQUIRE(device.path_clearance(path, &safe, MICROTIN_FLAG_SAFE) != MICROTIN_QUERY_NO_MARGIN);
  if (surface.least == INT32_MAX) return;
  REQUIRE(safe.least <= surface.least);
  REQUIRE(safe.least >= surface.least - static_cast<int32_t>(info.below) * 16);
  if (surface.first_along >= 0) REQUIRE(safe.first_along <= surface.first_along);
}

TEST_CASE_TEMPLATE("pack: the clearance of a path is exact, and lower by the margin if safe" *
                       kSlow,
                   Device, MeshSlots, CompactSlots) {
  Random random(41);
  ClearanceCounts counts;
  for (const VoidKind& kind : void_kinds()) {
    CAPTURE(kind.name);
    Card card{write_pack(encode_pack(rough_raster(61, 53, kind.at), pack_options(3, 100)))};
    const PackFile pack(card.bytes);
    const Surface surface = surface_of(pack);
    const TileGrid& grid = pack.grid();
    const Device device(static_cast<uint32_t>(pack.entries().size()));
    const microtin_segment all = {0, 0, int64_t{grid.x_max} * 256, int64_t{grid.y_max} * 256};
    for (uint32_t tile = 0; tile < pack.entries().size(); ++tile) {
      const TileBox box = tile_box(grid, tile);
      REQUIRE(device.load(card, at(box.x, box.y)) == MICROTIN_STATUS_OK);
      REQUIRE(device.load(card, at(box.x_end, box.y_end)) == MICROTIN_STATUS_OK);
    }
    int32_t most = 1;
    for (const auto& v : surface.vertices) most = std::max(most, static_cast<int32_t>(v[2]));
    for (int i = 0; i < tried(60); ++i) {
      const auto pick = [&](int64_t end) {
        return static_cast<int64_t>(random.below(static_cast<uint32_t>(end + 1)));
      };
      microtin_segment c = {pick(all.x_end), pick(all.y_end), pick(all.x_end), pick(all.y_end)};
      if (i % 5 == 0) c.x = c.x_end = c.x / 256 / grid.width * grid.width * 256;
      if (i % 7 == 0) c.x_end = c.x, c.y_end = c.y;
      const microtin_path path = path_over(c, most, random);
      microtin_path_clearance found;
      microtin_segment_extremes extremes;
      CHECK(device.path_clearance(path, &found, 0) == device.segment_extremes(c, &extremes));
      REQUIRE(clearance_fault(surface, path, 0, found) == "");
      check_safe(device, path, found);
      counts.add(found);
    }
  }
  CHECK(counts.clear > tried(20));
  CHECK(counts.low > tried(20));
}

TEST_CASE_TEMPLATE("pack: a safe path that is a place on a border takes the largest margin there",
                   Device, MeshSlots, CompactSlots) {
  Card card{write_pack(encode_pack(rough_raster(61, 53), pack_options(3, 100)))};
  const PackFile pack(card.bytes);
  const TileGrid& grid = pack.grid();
  const Device device(4);
  int different = 0;
  for (uint32_t x = grid.width; x < grid.x_max; x += grid.width) {
    for (uint32_t y = grid.height; y < grid.y_max; y += grid.height) {
      const microtin_segment here = at(x, y);
      REQUIRE(device.load(card, here) == MICROTIN_STATUS_OK);
      uint32_t largest = 0, first = 0;
      for (TouchedTiles tiles(grid, here); !tiles.at_end(); tiles.next()) {
        const PackEntry& entry = pack.entries()[tiles.number()];
        microtin_stream_info info;
        REQUIRE(microtin_read_stream_info(card.bytes.data() + entry.offset, entry.size, &info) ==
                MICROTIN_STATUS_OK);
        if (largest == 0) first = info.below;
        largest = std::max(largest, info.below);
      }
      if (first != largest) ++different;
      int32_t height = 0;
      REQUIRE(device.height_at(here.x, here.y, height) == MICROTIN_QUERY_OK);
      microtin_path_clearance found;
      CHECK(device.path_clearance({here, 90000, 90000, 0}, &found, MICROTIN_FLAG_SAFE) ==
            MICROTIN_QUERY_OK);
      CHECK(found.least == 90000 - (height >> 8) - static_cast<int32_t>(largest) * 16);
    }
  }
  CHECK(different > 0);
}

TEST_CASE_TEMPLATE("pack: the first low place on a border of tiles that disagree is the first",
                   Device, MeshSlots, CompactSlots) {
  const ForgedTile deep = forged_tile({{{0, 0, -9}, {4, 0, -9}, {0, 4, -9}, {4, 4, -9}}, {}});
  // Low where they begin or end, on the left side or on the right one.
  const auto begins = [](uint16_t x) {
    const uint16_t other = static_cast<uint16_t>(4 - x);
    return forged_tile({{{x, 0, 0}, {other, 0, -9}, {x, 1, -9}, {x, 4, -9}, {other, 4, -9}}, {}});
  };
  const auto ends = [](uint16_t x) {
    const uint16_t other = static_cast<uint16_t>(4 - x);
    return forged_tile({{{x, 0, -9}, {other, 0, -9}, {x, 4, 9}, {other, 4, -9}}, {}});
  };
  for (const bool is_left : {false, true}) {
    CAPTURE(is_left);
    Card card{forged_pack({8, 8, 4, 4},
                          is_left ? std::vector<ForgedTile>{deep, deep, begins(4), ends(0)}
                                  : std::vector<ForgedTile>{deep, deep, ends(4), begins(0)})};
    const Device device(4);
    REQUIRE(device.load(card, at(4, 4)) == MICROTIN_STATUS_OK);
    const microtin_path path = {{1024, 0, 1024, 1792}, 0, 0, 256};
    microtin_path_clearance found;
    CHECK(device.path_clearance(path, &found, 0) == MICROTIN_QUERY_OK);
    CHECK(clearance_fault(surface_of(PackFile(card.bytes)), path, 0, found) == "");
  }
}

}  // namespace microtin::tests
