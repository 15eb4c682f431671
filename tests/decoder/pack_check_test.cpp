// SPDX-License-Identifier: MIT
// A device checks before take-off whether tiles are there and whole.
#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "decoder/touched_tiles.hpp"
#include "tests/support/pack_device.hpp"
#include "tests/support/packs.hpp"

namespace microtin::tests {
namespace {

struct FoundTiles : microtin_pack_check {
  microtin_status status;
};

FoundTiles check_with(const PackDevice& device, Card& card, const microtin_segment& area,
                      bool is_box) {
  FoundTiles found{};
  found.status =
      microtin_pack_check_with(device.pack, &area, is_box ? 1 : 0, &found, Card::read, &card);
  return found;
}

Card card_of(const Raster& raster) {
  return Card{pack_bytes(raster)};
}

// Changes a byte of each stream of these tiles.
void damage(Card& card, const std::set<uint32_t>& tiles) {
  const PackFile pack(card.bytes);
  for (const uint32_t tile : tiles) {
    card.bytes[static_cast<size_t>(pack.entries()[tile].offset) + 30] ^= 1;
  }
}

std::set<uint32_t> some_tiles(const PackFile& pack, Random& random, uint32_t percent) {
  std::set<uint32_t> tiles;
  for (uint32_t tile = 0; tile < pack.tiles(); ++tile) {
    if (pack.entries()[tile].size > 30 && random.below(100) < percent) tiles.insert(tile);
  }
  return tiles;
}

}  // namespace

TEST_CASE_TEMPLATE("pack check: whole packs pass, and damaged tiles are counted", Device, MeshSlots,
                   CompactSlots) {
  Random random(3);
  for (const uint32_t percent : {0u, 5u, 60u, 100u}) {
    Card card = card_of(raster_with_hole());
    const PackFile pack(card.bytes);
    const std::set<uint32_t> bad = some_tiles(pack, random, percent);
    damage(card, bad);
    const Device device(2);
    const FoundTiles found = check_with(device, card, whole(pack.grid()), true);
    CHECK(found.status == (bad.empty() ? MICROTIN_STATUS_OK : MICROTIN_STATUS_BAD_TILES));
    CHECK(found.tiles == pack.tiles());
    CHECK(found.bad == bad.size());
    if (!bad.empty()) CHECK(found.first_bad == *bad.begin());
    CHECK(found.is_inside == 1);
    CHECK(found.without_terrain ==
          std::count_if(pack.entries().begin(), pack.entries().end(),
                        [](const IndexEntry& entry) { return entry.size == 0; }));
    CHECK(found.without_terrain > 0);
  }
}

TEST_CASE_TEMPLATE("pack check: a segment's tiles are those that loading touches", Device,
                   MeshSlots, CompactSlots) {
  Card card = card_of(rough_raster(61, 53));
  const PackFile pack(card.bytes);
  Random random(4);
  const std::set<uint32_t> bad = some_tiles(pack, random, 20);
  damage(card, bad);
  const Device device(1);
  const auto place = [&](uint32_t most) {
    return static_cast<int64_t>(random.below(most * 256 + 513)) - 256;
  };
  for (int i = 0; i < 100; ++i) {
    const microtin_segment segment = {place(60), place(52), i % 4 == 0 ? 0 : place(60), place(52)};
    uint32_t tiles = 0, expected = 0;
    for (TouchedTiles at(pack.grid(), segment); !at.at_end(); at.next()) {
      ++tiles;
      expected += static_cast<uint32_t>(bad.count(at.number()));
    }
    const FoundTiles found = check_with(device, card, segment, false);
    CHECK(found.tiles == tiles);
    CHECK(found.bad == expected);
    const auto is_within = [](int64_t v, int64_t most) { return v >= 0 && v <= most * 256; };
    CHECK((found.is_inside == 1) == (is_within(segment.x, 60) && is_within(segment.x_end, 60) &&
                                     is_within(segment.y, 52) && is_within(segment.y_end, 52)));
  }
}

TEST_CASE_TEMPLATE("pack check: a box has the tiles that it meets in more than its sides", Device,
                   MeshSlots, CompactSlots) {
  Card card = card_of(rough_raster(61, 53));
  const PackFile pack(card.bytes);
  const TileGrid& grid = pack.grid();
  const Device device(1);
  const auto tiles_of = [&](int64_t x, int64_t y, int64_t x_end, int64_t y_end) {
    const microtin_segment diagonal = {x * 256, y_end * 256, x_end * 256, y * 256};
    return check_with(device, card, diagonal, true).tiles;
  };
  const int64_t width = grid.width, height = grid.height;
  CHECK(tiles_of(0, 0, width, height) == 1);
  CHECK(tiles_of(1, 1, width + 1, height) == 2);
  CHECK(tiles_of(width, height, width, height) == 1);
  CHECK(tiles_of(width - 1, height - 1, width + 1, height + 1) == 4);
  CHECK(tiles_of(-500, -500, 500, 500) == pack.tiles());
  CHECK(tiles_of(-500, -500, -1, 500) == 0);
  CHECK(tiles_of(60, 52, 60, 52) == 1);
}

TEST_CASE_TEMPLATE("pack check: calls read once, and loading and queries go on between", Device,
                   MeshSlots, CompactSlots) {
  Card card = card_of(rough_raster(61, 53));
  card.most = 50;
  const PackFile pack(card.bytes);
  const microtin_segment all = whole(pack.grid());
  const Device device(4);
  REQUIRE(device.load(card, at(30, 26)) == MICROTIN_STATUS_OK);
  int32_t first = 0;
  REQUIRE(device.height_at(30 * 256, 26 * 256, first) == MICROTIN_QUERY_OK);
  microtin_pack_check check{};
  microtin_status status = MICROTIN_STATUS_NEED_INPUT;
  Random random(5);
  uint32_t calls = 0, failures = 0;
  for (; status == MICROTIN_STATUS_NEED_INPUT || status == MICROTIN_STATUS_IO; ++calls) {
    REQUIRE(calls < 20000);
    card.is_pulled = random.below(5) == 0;
    const uint32_t reads = card.reads;
    microtin_pack_read_once(device.pack, Card::read, &card);
    CHECK(card.reads <= reads + 1);
    status = microtin_pack_check_box(device.pack, &all, &check);
    if (status == MICROTIN_STATUS_IO) ++failures;
    card.is_pulled = false;
    // The tile that a vehicle is above is loaded in between, and another for a while.
    if (random.below(40) == 0) {
      const microtin_segment there = at(random.below(61), random.below(53));
      for (uint32_t k = random.below(9); k != 0; --k) device.load(card, there, 5);
      REQUIRE(device.load(card, at(30, 26)) == MICROTIN_STATUS_OK);
    }
    int32_t height = 0;
    REQUIRE(device.height_at(30 * 256, 26 * 256, height) == MICROTIN_QUERY_OK);
    REQUIRE(height == first);
  }
  CHECK(status == MICROTIN_STATUS_OK);
  CHECK(check.tiles == pack.tiles());
  CHECK(check.bad == 0);
  CHECK(failures > 0);
}

TEST_CASE_TEMPLATE("pack check: tiles are loaded as before while and after a check", Device,
                   MeshSlots, CompactSlots) {
  Card card = card_of(rough_raster(61, 53));
  const PackFile pack(card.bytes);
  const microtin_segment all = whole(pack.grid());
  const Device device(4);
  Random random(6);
  microtin_pack_check check{};
  for (int i = 0; i < 200; ++i) {
    const microtin_segment there = at(random.below(61), random.below(53));
    for (uint32_t k = random.below(30); k != 0; --k) device.load(card, there, 3);
    microtin_pack_read_once(device.pack, Card::read, &card);
    if (microtin_pack_check_box(device.pack, &all, &check) == MICROTIN_STATUS_OK) check = {};
    REQUIRE(device.load(card, there) == MICROTIN_STATUS_OK);
    int32_t height = 0;
    REQUIRE(device.height_at(there.x, there.y, height) == MICROTIN_QUERY_OK);
    CHECK(height == *expected_height(pack, there.x, there.y));
  }
}

TEST_CASE_TEMPLATE("pack check: a tile that is being decoded is checked from its beginning", Device,
                   MeshSlots, CompactSlots) {
  Card card = card_of(rough_raster(61, 53));
  const microtin_segment all = whole(PackFile(card.bytes).grid());
  const Device device(1);
  while (device.load(card, at(30, 26), 1) != MICROTIN_STATUS_STEP_LIMIT) {
  }
  CHECK(check_with(device, card, at(30, 26), false).status == MICROTIN_STATUS_OK);
  CHECK(check_with(device, card, all, true).status == MICROTIN_STATUS_OK);
  CHECK(device.load(card, at(30, 26)) == MICROTIN_STATUS_OK);
}

TEST_CASE("pack check: headers, cards that end, and wrong arguments") {
  Card card = card_of(rough_raster(61, 53));
  const MeshSlots device(2);
  const microtin_segment all = whole(PackFile(card.bytes).grid());
  microtin_pack_check check{};
  CHECK(microtin_pack_check_box(nullptr, &all, &check) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_pack_check_box(device.pack, &all, nullptr) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_pack_check_segment(device.pack, nullptr, &check) == MICROTIN_STATUS_ARGUMENT);
  const microtin_segment far = {0, 0, int64_t{1} << 24, 0};
  CHECK(microtin_pack_check_box(device.pack, &far, &check) == MICROTIN_STATUS_ARGUMENT);
  Card cut = card;
  cut.bytes.resize(cut.bytes.size() - 100);
  const FoundTiles found = check_with(device, cut, all, true);
  CHECK(found.status == MICROTIN_STATUS_BAD_TILES);
  CHECK(found.bad >= 1);
  microtin_pack_reset(device.pack);
  cut.bytes.resize(40);
  CHECK(check_with(device, cut, all, true).status == MICROTIN_STATUS_TRUNCATED);
  cut.bytes = card.bytes;
  cut.bytes[20] ^= 1;
  microtin_pack_reset(device.pack);
  CHECK(check_with(device, cut, all, true).status == MICROTIN_STATUS_CHECKSUM);
  CHECK(check_with(device, cut, all, false).status == MICROTIN_STATUS_CHECKSUM);
}

}  // namespace microtin::tests
