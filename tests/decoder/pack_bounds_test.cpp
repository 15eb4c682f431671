// SPDX-License-Identifier: MIT
// A device learns from the index between which heights an area lies.
#include <doctest/doctest.h>

#include <algorithm>
#include <optional>

#include "decoder/touched_tiles.hpp"
#include "tests/support/pack_device.hpp"
#include "tests/support/packs.hpp"

namespace microtin::tests {
namespace {

// Bounds by the vertices of some tiles.
struct BruteForceBounds {
  uint32_t tiles = 0, without_terrain = 0;
  int lowest = INT16_MAX, highest = INT16_MIN;

  void add(const PackFile& pack, uint32_t number) {
    ++tiles;
    const std::optional<DecodedTerrain> tile = pack.tile(number);
    if (!tile) ++without_terrain;
    for (uint32_t i = 0; tile && i < microtin_mesh_vertex_count(tile->mesh()); ++i) {
      uint16_t x = 0, y = 0;
      int16_t z = 0;
      microtin_mesh_vertex(tile->mesh(), i, &x, &y, &z);
      lowest = std::min<int>(lowest, z);
      highest = std::max<int>(highest, z);
    }
  }
};

struct FoundBounds : microtin_pack_bounds {
  microtin_status status;
};

FoundBounds bounds_with(const PackDevice& device, Card& card, const microtin_segment& area,
                        bool is_box) {
  FoundBounds found{};
  found.status =
      microtin_pack_bounds_with(device.pack, &area, is_box ? 1 : 0, &found, Card::read, &card);
  return found;
}

microtin_pack_info info_of(const PackDevice& device) {
  microtin_pack_info info;
  REQUIRE(microtin_pack_get_info(device.pack, &info) == MICROTIN_STATUS_OK);
  return info;
}

void check_found(const microtin_pack_bounds& found, const BruteForceBounds& expected) {
  CHECK(found.check.tiles == expected.tiles);
  CHECK(found.check.without_terrain == expected.without_terrain);
  CHECK(found.check.bad == 0);
  if (expected.tiles == expected.without_terrain) return;
  CHECK(found.lowest == expected.lowest);
  CHECK(found.highest == expected.highest);
}

}  // namespace

TEST_CASE_TEMPLATE("pack bounds: a segment's are those of the tiles that it touches", Device,
                   MeshSlots, CompactSlots) {
  Card card{pack_bytes(raster_with_hole())};
  const PackFile pack(card.bytes);
  const Device device(2);
  Random random(41);
  const auto place = [&](uint32_t most) {
    return static_cast<int64_t>(random.below(most * 256 + 513)) - 256;
  };
  for (int i = 0; i < 200; ++i) {
    const microtin_segment segment = {place(60), place(52), i % 4 == 0 ? 0 : place(60), place(52)};
    BruteForceBounds expected;
    for (TouchedTiles tiles(pack.grid(), segment); !tiles.at_end(); tiles.next()) {
      expected.add(pack, tiles.number());
    }
    if (i % 3 == 0) device.load(card, segment, 7);
    check_found(bounds_with(device, card, segment, false), expected);
  }
}

TEST_CASE("pack bounds: a box's are those of the tiles that it overlaps") {
  Card card{pack_bytes(raster_with_hole())};
  const PackFile pack(card.bytes);
  const MeshSlots device(1);
  Random random(42);
  for (int i = 0; i < 200; ++i) {
    const int64_t x = random.below(61 * 256) - 300, y = random.below(53 * 256) - 300,
                  x_end = x + 1 + random.below(20 * 256), y_end = y + 1 + random.below(20 * 256);
    BruteForceBounds expected;
    for (uint32_t tile = 0; tile < pack.tiles(); ++tile) {
      const TileBox box = tile_box(pack.grid(), tile);
      const bool is_apart = x_end <= int64_t{box.x} * 256 || x >= int64_t{box.x_end} * 256 ||
                            y_end <= int64_t{box.y} * 256 || y >= int64_t{box.y_end} * 256;
      if (!is_apart) expected.add(pack, tile);
    }
    check_found(bounds_with(device, card, {x, y_end, x_end, y}, true), expected);
  }
}

TEST_CASE("pack bounds: entries are read, streams are not") {
  Card card{pack_bytes(rough_raster(61, 53))};
  const PackFile pack(card.bytes);
  const uint64_t index_end = pack.entries()[0].offset;
  std::fill(card.bytes.begin() + static_cast<std::ptrdiff_t>(index_end), card.bytes.end(),
            uint8_t{0});
  const MeshSlots device(1);
  const FoundBounds found = bounds_with(device, card, whole(pack.grid()), true);
  CHECK(found.status == MICROTIN_STATUS_OK);
  CHECK(found.check.tiles == pack.tiles());
  CHECK(card.reads < pack.tiles() + 6);
}

TEST_CASE_TEMPLATE("pack bounds: of damaged and absent entries nothing is known", Device, MeshSlots,
                   CompactSlots) {
  Card card{pack_bytes(rough_raster(61, 53))};
  const PackFile pack(card.bytes);
  const size_t index = static_cast<size_t>(pack.entries()[0].offset) - pack.tiles() * 20;
  REQUIRE(pack.tiles() == 9);
  card.bytes[index + 3 * 20 + 12] ^= 1;
  const Device device(2);
  for (int i = 0; i < 3; ++i) {  // a tile is remembered once, however often its entry is read
    const FoundBounds found = bounds_with(device, card, whole(pack.grid()), true);
    CHECK(found.status == MICROTIN_STATUS_BAD_TILES);
    CHECK(found.check.bad == 1);
    CHECK(found.check.first_bad == 3);
    const microtin_pack_info info = info_of(device);
    CHECK(microtin_pack_is_clear(&found, &info, INT32_MAX, 0) == 0);
  }
  uint32_t remembered = 0, tile = 0, why = 0;
  for (uint32_t i = 0; i < MICROTIN_PACK_MAX_BAD_TILES; ++i) {
    if (microtin_pack_bad_tile(device.pack, i, &tile, &why) == MICROTIN_STATUS_OK) ++remembered;
  }
  CHECK(remembered == 1);
  card.bytes.resize(index + 5 * 20);
  const FoundBounds cut = bounds_with(device, card, whole(pack.grid()), true);
  CHECK(cut.status == MICROTIN_STATUS_BAD_TILES);
  CHECK(cut.check.bad == pack.tiles() - 4);
}

TEST_CASE_TEMPLATE("pack bounds: a damaged entry is read again, also one that was kept", Device,
                   MeshSlots, CompactSlots) {
  Card card{pack_bytes(rough_raster(61, 53))};
  const PackFile pack(card.bytes);
  const TileBox second = tile_box(pack.grid(), 1);
  const microtin_segment there = at(second.x + 1, second.y + 1);
  uint8_t& byte = card.bytes[static_cast<size_t>(pack_entry_start(pack.header(), 1)) + 12];
  for (const uint32_t sector : {0u, 512u}) {
    const Device device(2);
    microtin_pack_align_reads(device.pack, sector);
    byte ^= 1;
    // If reads are aligned, this keeps entries.
    REQUIRE(device.load(card, at(1, 1)) == MICROTIN_STATUS_OK);
    CHECK(bounds_with(device, card, there, false).status == MICROTIN_STATUS_BAD_TILES);
    byte ^= 1;
    CHECK(bounds_with(device, card, there, false).status == MICROTIN_STATUS_OK);
  }
}

TEST_CASE_TEMPLATE("pack bounds: calls read once, and loading and queries go on between", Device,
                   MeshSlots, CompactSlots) {
  Card card{pack_bytes(rough_raster(61, 53))};
  card.most = 7;
  const PackFile pack(card.bytes);
  const microtin_segment all = whole(pack.grid());
  BruteForceBounds expected;
  for (uint32_t tile = 0; tile < pack.tiles(); ++tile) expected.add(pack, tile);
  const Device device(4);
  for (const uint32_t sector : {0u, 64u, 512u}) {
    microtin_pack_align_reads(device.pack, sector);
    Random random(43 + sector);
    microtin_pack_bounds bounds{};
    microtin_status status = MICROTIN_STATUS_NEED_INPUT;
    uint32_t failures = 0;
    while (status == MICROTIN_STATUS_NEED_INPUT || status == MICROTIN_STATUS_IO) {
      card.is_pulled = random.below(5) == 0;
      const uint32_t reads = card.reads;
      microtin_pack_read_once(device.pack, Card::read, &card);
      CHECK(card.reads <= reads + 1);
      status = microtin_pack_bounds_in_box(device.pack, &all, &bounds);
      failures += status == MICROTIN_STATUS_IO ? 1u : 0u;
      card.is_pulled = false;
      if (random.below(20) != 0) continue;
      const microtin_segment there = at(random.below(61), random.below(53));
      for (uint32_t k = random.below(9); k != 0; --k) device.load(card, there, 5);
      REQUIRE(device.load(card, there) == MICROTIN_STATUS_OK);
      int32_t height = 0;
      REQUIRE(device.height_at(there.x, there.y, height) == MICROTIN_QUERY_OK);
      CHECK(height == *expected_height(pack, there.x, there.y));
    }
    CHECK(status == MICROTIN_STATUS_OK);
    CHECK(failures > 0);
    check_found(bounds, expected);
  }
}

TEST_CASE_TEMPLATE("pack bounds: each turn of a loop finds them, and no tile is read twice", Device,
                   MeshSlots, CompactSlots) {
  Card card{pack_bytes(rough_raster(61, 53))};
  card.most = 7;
  const PackFile pack(card.bytes);
  const microtin_segment all = whole(pack.grid()), there = at(30, 26);
  uint32_t reads = 0;
  {
    const Device device(4);
    REQUIRE(device.load(card, there) == MICROTIN_STATUS_OK);
    reads = card.reads;
  }
  const Device device(4);
  card.reads = 0;
  uint32_t looks = 0;
  microtin_status status = MICROTIN_STATUS_NEED_INPUT;
  for (uint32_t turn = 0; turn < 5000 && status != MICROTIN_STATUS_OK; ++turn) {
    status = device.load(card, there, 5);
    const uint32_t before = card.reads;
    CHECK(bounds_with(device, card, all, true).check.tiles == pack.tiles());
    looks += card.reads - before;
  }
  CHECK(status == MICROTIN_STATUS_OK);
  CHECK(card.reads - looks <= reads);
}

// Loads and looks without end, one call of each in a turn of a loop.
template <class Device>
void take_turns(bool reads_before_each) {
  Card card{pack_bytes(rough_raster(61, 53))};
  const PackFile pack(card.bytes);
  const microtin_segment all = whole(pack.grid());
  const Device device(1);
  microtin_pack_bounds bounds{};
  uint32_t loaded = 0, looks = 0;
  const auto read = [&] { microtin_pack_read_once(device.pack, Card::read, &card); };
  for (uint32_t turn = 0; turn < 5000; ++turn) {
    if (reads_before_each) read();
    const microtin_segment there = loaded % 2 == 0 ? at(1, 1) : at(60, 52);
    if (device.load_without_reading(there, 50) == MICROTIN_STATUS_OK) ++loaded;
    if (reads_before_each) read();
    while (microtin_pack_bounds_in_box(device.pack, &all, &bounds) == MICROTIN_STATUS_OK) {
      ++looks;
      bounds = microtin_pack_bounds{};
    }
    if (!reads_before_each) read();
  }
  CHECK(loaded > 20);
  CHECK(looks > 20);
}

TEST_CASE_TEMPLATE("pack bounds: neither they nor loading starve, wherever a loop reads", Device,
                   MeshSlots, CompactSlots) {
  for (const bool reads_before_each : {false, true}) take_turns<Device>(reads_before_each);
}

TEST_CASE("pack bounds: tiles may lie on one side of 0 alone") {
  Raster slope = rough_raster(61, 53);
  for (uint32_t i = 0; i < slope.heights.size(); ++i)
    slope.heights[i] += 40 * int64_t{i % 61} - 1200;
  Card card{pack_bytes(slope)};
  const PackFile pack(card.bytes);
  const MeshSlots device(1);
  for (const uint32_t x : {5u, 55u}) {
    BruteForceBounds expected;
    for (TouchedTiles tiles(pack.grid(), at(x, 25)); !tiles.at_end(); tiles.next()) {
      expected.add(pack, tiles.number());
    }
    CHECK((x == 5 ? expected.highest < 0 : expected.lowest > 0));
    check_found(bounds_with(device, card, at(x, 25), false), expected);
  }
}

TEST_CASE("pack bounds: what storage reported to a loading call does not count") {
  Card card{pack_bytes(rough_raster(61, 53))};
  const MeshSlots device(1);
  bounds_with(device, card, at(1, 1), false);  // brings the header
  REQUIRE(device.load_without_reading(at(30, 26), 1) == MICROTIN_STATUS_NEED_INPUT);
  microtin_pack_complete_read(device.pack, -1);
  CHECK(bounds_with(device, card, whole(PackFile(card.bytes).grid()), true).status ==
        MICROTIN_STATUS_OK);
}

TEST_CASE("pack bounds: clear is what lies inside, has terrain, and is below") {
  Card card{pack_bytes(raster_with_hole())};
  const PackFile pack(card.bytes);
  const MeshSlots device(1);
  const auto is_clear = [&](const microtin_segment& area, int64_t height, uint32_t flags) {
    const FoundBounds found = bounds_with(device, card, area, true);
    REQUIRE(found.status == MICROTIN_STATUS_OK);
    const microtin_pack_info info = info_of(device);
    return microtin_pack_is_clear(&found, &info, static_cast<int32_t>(height), flags) == 1;
  };
  const microtin_segment east = {50 * 256, 40 * 256, 55 * 256, 45 * 256};
  const int64_t highest = int64_t{bounds_with(device, card, east, true).highest} * 65536;
  const int64_t margin = int64_t{info_of(device).below} * 4096;
  CHECK(is_clear(east, highest + 1, 0));
  CHECK_FALSE(is_clear(east, highest, 0));
  CHECK(is_clear(east, highest + margin + 1, MICROTIN_FLAG_SAFE));
  CHECK_FALSE(is_clear(east, highest + margin, MICROTIN_FLAG_SAFE));
  CHECK_FALSE(is_clear({0, 0, 10 * 256, 10 * 256}, INT32_MAX, 0));                // has no terrain
  CHECK_FALSE(is_clear({50 * 256, 40 * 256, 61 * 256, 45 * 256}, INT32_MAX, 0));  // leaves it
  CHECK_FALSE(is_clear({70 * 256, 40 * 256, 71 * 256, 45 * 256}, INT32_MAX, 0));
}

TEST_CASE("pack bounds: headers and wrong arguments") {
  Card card{pack_bytes(rough_raster(61, 53))};
  const microtin_segment all = whole(PackFile(card.bytes).grid());
  const MeshSlots device(2);
  microtin_pack_bounds bounds{};
  CHECK(microtin_pack_bounds_in_box(nullptr, &all, &bounds) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_pack_bounds_in_box(device.pack, &all, nullptr) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_pack_bounds_on_segment(device.pack, nullptr, &bounds) == MICROTIN_STATUS_ARGUMENT);
  const microtin_segment far = {0, 0, int64_t{1} << 24, 0};
  CHECK(microtin_pack_bounds_on_segment(device.pack, &far, &bounds) == MICROTIN_STATUS_ARGUMENT);
  card.bytes[20] ^= 1;
  CHECK(bounds_with(device, card, all, true).status == MICROTIN_STATUS_CHECKSUM);
}

}  // namespace microtin::tests
