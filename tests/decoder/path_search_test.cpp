// SPDX-License-Identifier: MIT
// The search along a path loads few tiles and finds what all tiles say: against exact fractions,
// and against devices that hold all tiles.
#include <doctest/doctest.h>

#include <algorithm>

#include "decoder/touched_tiles.hpp"
#include "microtin/compact_pack.hpp"
#include "tests/support/forged_pack.hpp"
#include "tests/support/pack_device.hpp"
#include "tests/support/packs.hpp"
#include "tests/support/reference_clearance.hpp"
#include "tests/support/sanitized.hpp"

namespace microtin::tests {
namespace {

using namespace reference;

constexpr uint32_t kMostCalls = 20000;

struct FoundPath : microtin_path_search {
  FoundPath() : microtin_path_search() {}
  microtin_status status = MICROTIN_STATUS_OK;
};

FoundPath search(const PackDevice& device, Card& card, const microtin_path& path,
                 uint32_t flags = 0) {
  FoundPath found;
  found.status = device.search_path_with(path, flags, &found, card);
  return found;
}

// In calls of one work unit, of which each makes at most one read.
FoundPath search_in_pieces(const PackDevice& device, Card& card, const microtin_path& path,
                           uint32_t flags) {
  FoundPath found;
  for (uint32_t i = 0; i < kMostCalls; ++i) {
    microtin_pack_read_once(device.pack, Card::read, &card);
    const uint32_t decoded = found.decoded;
    found.status = device.search_path(path, flags, &found, 1);
    CHECK(found.decoded <= decoded + 1);
    if (found.status != MICROTIN_STATUS_NEED_INPUT && found.status != MICROTIN_STATUS_STEP_LIMIT) {
      return found;
    }
  }
  FAIL("the search has no end");
  return found;
}

void check_equal(const microtin_path_clearance& found, const microtin_path_clearance& expected) {
  CHECK(found.least == expected.least);
  CHECK(found.least_along == expected.least_along);
  CHECK(found.first_along == expected.first_along);
}

// A device that holds all tiles, but bad ones.
template <class Device>
void fill(const Device& device, Card& card, const PackFile& pack) {
  for (uint32_t tile = 0; tile < pack.entries().size(); ++tile) {
    const TileBox box = tile_box(pack.grid(), tile);
    const int64_t x = (int64_t{box.x} + box.x_end) * 128, y = (int64_t{box.y} + box.y_end) * 128;
    device.load(card, {x, y, x, y});
  }
}

// Above, in and below the terrain, which reaches up to `most`; sometimes along a border.
microtin_path some_path(const TileGrid& grid, int32_t most, Random& random) {
  const auto place = [&](uint32_t end) {
    return static_cast<int64_t>(random.below(end * 256 + 1025)) - 512;
  };
  microtin_segment c = {place(grid.x_max), place(grid.y_max), place(grid.x_max), place(grid.y_max)};
  if (random.below(5) == 0) c.x = c.x_end = c.x / 256 / grid.width * grid.width * 256;
  if (random.below(5) == 0) c.y = c.y_end = c.y / 256 / grid.height * grid.height * 256;
  const auto height = [&] {
    return static_cast<int32_t>(random.below(static_cast<uint32_t>(most) * 512));
  };
  return {c, height(), height(), height() / 8};
}

struct Counts {
  uint32_t tiles = 0, decoded = 0, first_only = 0;
};

template <class Device>
void check_path(const Device& whole_device, const Device& device, Card& card,
                const Surface& surface, const microtin_path& path, Counts& counts) {
  microtin_path_clearance expected;
  const bool is_outside = whole_device.path_clearance(path, &expected, 0) == MICROTIN_QUERY_OUTSIDE;
  microtin_pack_reset(device.pack);
  const FoundPath found = search(device, card, path);
  CHECK(found.status == MICROTIN_STATUS_OK);
  CHECK(found.result == (is_outside ? MICROTIN_QUERY_OUTSIDE : MICROTIN_QUERY_OK));
  check_equal(found.clearance, expected);
  REQUIRE(clearance_fault(surface, path, 0, found.clearance) == "");
  counts.tiles += found.tiles;
  counts.decoded += found.decoded;
  check_equal(search_in_pieces(device, card, path, 0).clearance, expected);

  const FoundPath first = search(device, card, path, MICROTIN_FLAG_FIRST_ONLY);
  check_equal(first.clearance, {INT32_MAX, 0, expected.first_along});
  counts.first_only += first.decoded;

  whole_device.path_clearance(path, &expected, MICROTIN_FLAG_SAFE);
  const FoundPath safe = search_in_pieces(device, card, path, MICROTIN_FLAG_SAFE);
  check_equal(safe.clearance, expected);
}

// Rough ground with a ridge from south to north, as high as `ridge`.
Raster ridge_raster(int64_t ridge) {
  Raster raster = rough_raster(61, 53);
  for (uint32_t y = 0; y < 53; ++y) {
    for (uint32_t x = 0; x < 61; ++x) {
      const int64_t away = x < 40 ? 40 - x : x - 40;
      if (away < 8) raster.heights[y * 61 + x] += ridge * (8 - away) / 8;
    }
  }
  return raster;
}

template <class Device>
void check_paths(const Raster& raster, uint32_t vertices, uint64_t seed, Counts& counts) {
  Random random(seed);
  Card card{write_pack(encode_pack(raster, pack_options(3, vertices)))};
  const PackFile pack(card.bytes);
  const Surface surface = surface_of(pack);
  int32_t most = 1;
  for (const auto& v : surface.vertices) most = std::max(most, static_cast<int32_t>(v[2]));
  const Device whole_device(static_cast<uint32_t>(pack.entries().size())), device(1);
  fill(whole_device, card, pack);
  for (int i = 0; i < tried(60); ++i) {
    CAPTURE(i);
    microtin_path path = some_path(pack.grid(), most, random);
    check_path(whole_device, device, card, surface, path, counts);
    path.segment.x_end = path.segment.x;  // a place, perhaps on a border
    path.segment.y_end = path.segment.y;
    Counts of_places;
    check_path(whole_device, device, card, surface, path, of_places);
  }
}

}  // namespace

TEST_CASE_TEMPLATE("path search: finds what all tiles say, whatever is void", Device, MeshSlots,
                   CompactSlots) {
  Counts counts;
  uint64_t seed = 91;
  for (const VoidKind& kind : void_kinds()) {
    CAPTURE(kind.name);
    check_paths<Device>(rough_raster(61, 53, kind.at), 100, ++seed, counts);
  }
  CHECK(counts.decoded < counts.tiles);
}

TEST_CASE_TEMPLATE("path search: decodes few tiles where the ground is lower than a ridge", Device,
                   MeshSlots, CompactSlots) {
  Counts counts;
  check_paths<Device>(ridge_raster(2000), 40, 92, counts);
  CHECK(counts.decoded < counts.tiles * 2 / 3);
  CHECK(counts.first_only < counts.decoded);
}

TEST_CASE_TEMPLATE("path search: bad tiles are passed, and what others say is found", Device,
                   MeshSlots, CompactSlots) {
  Random random(93);
  Card card{pack_bytes(rough_raster(61, 53))};
  const PackFile pack(card.bytes);
  REQUIRE(pack.tiles() == 9);
  const size_t index = static_cast<size_t>(pack.entries()[0].offset) - pack.tiles() * 20;
  card.bytes[index + 3 * 20 + 12] ^= 1;                                // an entry
  card.bytes[static_cast<size_t>(pack.entries()[4].offset) + 9] ^= 1;  // a stream
  const Device whole_device(9), device(1);
  fill(whole_device, card, pack);
  int bad = 0;
  for (int i = 0; i < 100; ++i) {
    const microtin_path path = some_path(pack.grid(), 60, random);
    microtin_path_clearance expected;
    whole_device.path_clearance(path, &expected, 0);
    bool has_bad = false;
    for (TouchedTiles tiles(pack.grid(), path.segment); !tiles.at_end(); tiles.next()) {
      has_bad = has_bad || tiles.number() == 3;
    }
    const FoundPath found = search_in_pieces(device, card, path, 0);
    check_equal(found.clearance, expected);
    if (has_bad) CHECK(found.status == MICROTIN_STATUS_BAD_TILES);
    CHECK((found.status == MICROTIN_STATUS_BAD_TILES) == (found.result == MICROTIN_QUERY_BAD_TILE));
    if (found.status == MICROTIN_STATUS_BAD_TILES) ++bad;
  }
  CHECK(bad > 20);
  CHECK(bad < 100);
}

TEST_CASE_TEMPLATE("path search: reads may fail, and other calls may come between", Device,
                   MeshSlots, CompactSlots) {
  Card card{pack_bytes(rough_raster(61, 53))};
  card.most = 7;
  const PackFile pack(card.bytes);
  const Device whole_device(9), device(2);
  fill(whole_device, card, pack);
  const microtin_path path = {{300, 200, 60 * 256, 51 * 256}, 4000, 9000, 700};
  microtin_path_clearance expected;
  whole_device.path_clearance(path, &expected, 0);
  FoundPath found;
  found.status = MICROTIN_STATUS_NEED_INPUT;
  for (uint32_t i = 0; i < kMostCalls && found.status != MICROTIN_STATUS_OK; ++i) {
    if (i % 5 == 0) card.failing = card.reads;
    if (i % 997 == 996) device.load(card, at(i % 60, i % 50), 3);
    microtin_pack_read_once(device.pack, Card::read, &card);
    found.status = device.search_path(path, 0, &found, 2);
    if (found.status == MICROTIN_STATUS_IO) found.status = MICROTIN_STATUS_NEED_INPUT;
    if (found.status == MICROTIN_STATUS_STEP_LIMIT) found.status = MICROTIN_STATUS_NEED_INPUT;
    REQUIRE((found.status == MICROTIN_STATUS_OK || found.status == MICROTIN_STATUS_NEED_INPUT));
  }
  CHECK(found.status == MICROTIN_STATUS_OK);
  check_equal(found.clearance, expected);
  // After the end a call repeats the result.
  CHECK(device.search_path(path, 0, &found, 2) == MICROTIN_STATUS_OK);
  check_equal(found.clearance, expected);
}

TEST_CASE_TEMPLATE("path search: whatever is damaged, it ends", Device, MeshSlots, CompactSlots) {
  Random random(94);
  const Bytes bytes = pack_bytes(raster_with_hole());
  const PackFile pack(bytes);
  for (int i = 0; i < tried(100); ++i) {
    Card card{bytes};
    const uint32_t most = static_cast<uint32_t>(random.below(2) == 0 ? bytes.size() : 400);
    for (int k = 0; k < 4; ++k) card.bytes[random.below(most)] ^= static_cast<uint8_t>(1u << k);
    if (random.below(4) == 0) card.bytes.resize(random.below(static_cast<uint32_t>(bytes.size())));
    const Device device(1);
    FoundPath found;
    // Any state.
    found.next = random.below(20);
    found.tiles = random.below(3);
    found.needs_tile = static_cast<uint8_t>(random.below(2));
    found.status =
        device.search_path_with(some_path(pack.grid(), 60, random), random.below(8), &found, card);
    CHECK(found.status != MICROTIN_STATUS_NEED_INPUT);
    CHECK(found.tiles <= 12);
  }
}

TEST_CASE_TEMPLATE("path search: a tile in a slot is not read, one that is ruled out neither",
                   Device, MeshSlots, CompactSlots) {
  const ForgedTile low = forged_tile({{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {4, 4, 0}}, {}}),
                   high = forged_tile({{{0, 0, 9}, {4, 0, 9}, {0, 4, 9}, {4, 4, 9}}, {}});
  Card card{forged_pack({12, 4, 4, 4}, {high, low, high})};
  const Device device(1);
  const microtin_path path = {{512, 512, 2560, 512}, 12 * 256, 12 * 256, 512};
  FoundPath found = search(device, card, path);
  CHECK(found.status == MICROTIN_STATUS_OK);
  CHECK(found.tiles == 3);
  CHECK(found.decoded == 1);  // the last one has no less clearance
  CHECK(found.clearance.least == 3 * 256);
  CHECK(found.clearance.first_along == -1);
  const uint32_t reads = card.reads;
  found = search(device, card, path);
  CHECK(found.decoded == 1);
  CHECK(card.reads == reads + 2);  // two entries
  found = search(device, card, path, MICROTIN_FLAG_FIRST_ONLY);
  CHECK(found.decoded == 1);  // as it is there
  device.load(card, at(6, 2));
  found = search(device, card, path, MICROTIN_FLAG_FIRST_ONLY);
  CHECK(found.clearance.first_along == -1);
  CHECK(found.decoded == 1);
}

TEST_CASE("path search: what is not legal, and what states no margin") {
  Card card{forged_pack({4, 4, 4, 4}, {forged_tile({{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {}})})};
  MeshSlots meshes(1);
  CompactSlots compact(1);
  const microtin_path path = {{256, 256, 512, 256}, 256, 256, 0};
  microtin_path_search found = {};
  CHECK(microtin_compact_pack_search_path(meshes.pack, &path, 0, &found, 0) ==
        MICROTIN_STATUS_WRONG_PACK_KIND);
  CHECK(microtin_pack_search_path(compact.pack, &path, 0, &found, 0) ==
        MICROTIN_STATUS_WRONG_PACK_KIND);
  CHECK(microtin_pack_search_path(nullptr, &path, 0, &found, 0) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_pack_search_path(meshes.pack, nullptr, 0, &found, 0) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_pack_search_path(meshes.pack, &path, 0, nullptr, 0) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_pack_search_path_with(meshes.pack, &path, 0, &found, nullptr, nullptr) ==
        MICROTIN_STATUS_ARGUMENT);
  for (const microtin_path& wrong : {microtin_path{{0, 0, 1 << 24, 0}, 0, 0, 0},
                                     microtin_path{{0, 0, 9, 0}, (1 << 25) + 1, 0, 0},
                                     microtin_path{{0, 0, 9, 0}, 0, 0, -(1 << 25) - 1}}) {
    CHECK(microtin_pack_search_path(meshes.pack, &wrong, 0, &found, 0) == MICROTIN_STATUS_ARGUMENT);
  }
  const FoundPath safe = search(meshes, card, path, MICROTIN_FLAG_SAFE);
  CHECK(safe.status == MICROTIN_STATUS_OK);
  CHECK(safe.result == MICROTIN_QUERY_NO_MARGIN);
  check_equal(safe.clearance, {INT32_MAX, 0, -1});
}

TEST_CASE("path search: the C++ face") {
  Card card{pack_bytes(rough_raster(61, 53))};
  const microtin_path path = {{256, 256, 60 * 256, 50 * 256}, 9000, 9000, 0};
  Pack<2, kCapacity> meshes;
  CompactPack<2, kCapacity> compact;
  microtin_path_search found = {}, other = {};
  CHECK(meshes.search_path_with(path, &found, Card::read, &card) == MICROTIN_STATUS_OK);
  CHECK(compact.search_path_with(path, &other, Card::read, &card) == MICROTIN_STATUS_OK);
  CHECK(found.tiles >= 3);
  check_equal(found.clearance, other.clearance);
}

}  // namespace microtin::tests
