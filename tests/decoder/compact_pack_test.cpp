// SPDX-License-Identifier: MIT
// What packs with compact slots have of their own; all else is in the tests of packs, which run
// with slots of both forms.
#include <doctest/doctest.h>

#include <algorithm>

#include "tests/support/forged_pack.hpp"
#include "tests/support/pack_device.hpp"
#include "tests/support/packs.hpp"

namespace microtin::tests {
namespace {

Bytes rough_pack() {
  return write_pack(encode_pack(rough_raster(61, 53), pack_options(3, 60)));
}

}  // namespace

TEST_CASE("compact pack: a tile that goes stays until the next is decoded") {
  Card card{rough_pack()};
  const PackFile pack(card.bytes);
  const TileGrid& grid = pack.grid();
  const CompactSlots device(1);
  const microtin_segment first = at(grid.width / 2, grid.height / 2),
                         second = at(grid.width * 3 / 2, grid.height / 2);
  REQUIRE(device.load(card, first) == MICROTIN_STATUS_OK);
  const int32_t old_height = *expected_height(pack, first.x, first.y),
                new_height = *expected_height(pack, second.x, second.y);
  microtin_status status = MICROTIN_STATUS_STEP_LIMIT;
  uint32_t with_old = 0, with_none = 0;
  while (status != MICROTIN_STATUS_OK) {
    status = device.load(card, second, 1);
    int32_t height = 0;
    const bool has_old = device.height_at(first.x, first.y, height) == MICROTIN_QUERY_OK;
    if (has_old) CHECK(height == old_height);
    const bool has_new = device.height_at(second.x, second.y, height) == MICROTIN_QUERY_OK;
    if (has_new) CHECK(height == new_height);
    CHECK(!(has_old && has_new));
    CHECK(has_new == (status == MICROTIN_STATUS_OK));
    ++(has_old ? with_old : with_none);
  }
  CHECK(with_old > 20);
  CHECK(with_none > 5);
  CHECK(with_none < with_old);  // while it is made compact
}

TEST_CASE("compact pack: changing the segment while a tile is made loses no work") {
  Card card{rough_pack()};
  const PackFile pack(card.bytes);
  const TileGrid& grid = pack.grid();
  const microtin_segment first = at(grid.width / 2, grid.height / 2),
                         second = at(grid.width * 3 / 2, grid.height / 2),
                         both = {first.x, first.y, second.x, second.y};
  for (int calls = 1; calls < 400; calls += 7) {
    const CompactSlots device(1);
    REQUIRE(device.load(card, first) == MICROTIN_STATUS_OK);
    for (int i = 0; i < calls; ++i) device.load(card, second, 1);
    int32_t height = 0;
    const bool is_there = device.height_at(first.x, first.y, height) == MICROTIN_QUERY_OK;
    const bool is_done = device.height_at(second.x, second.y, height) == MICROTIN_QUERY_OK;
    // A slot that the segment needs is not given away, whatever is decoded.
    if (is_there) {
      CHECK(device.load(card, both) == MICROTIN_STATUS_WORKSPACE_TOO_SMALL);
      CHECK(device.height_at(first.x, first.y, height) == MICROTIN_QUERY_OK);
    }
    REQUIRE(device.load(card, first) == MICROTIN_STATUS_OK);
    CHECK(device.height_at(first.x, first.y, height) == MICROTIN_QUERY_OK);
    CHECK(height == *expected_height(pack, first.x, first.y));
    if (is_done) break;
  }
}

TEST_CASE("compact pack: slots of the header's size are enough, smaller ones are refused") {
  const Bytes bytes = rough_pack();
  Card card{bytes};
  const PackFile pack(bytes);
  const uint32_t needed = pack.header().compact_bytes, most = pack.header().most_vertices;
  REQUIRE(needed != 0);
  static_assert(MICROTIN_INDEX_BITS == 32, "what is needed here is more");
  uint32_t largest = 0;
  std::vector<uint32_t> sizes;
  for (uint32_t tile = 0; tile < pack.entries().size(); ++tile) {
    sizes.push_back(static_cast<uint32_t>(bytes_of(compact_form(*pack.tile(tile)), 32)));
    largest = std::max(largest, sizes.back());
  }
  for (const uint32_t size : {largest, largest - 8}) {
    const CompactSlots device(4, most, size);
    for (uint32_t tile = 0; tile < sizes.size(); ++tile) {
      const TileBox box = tile_box(pack.grid(), tile);
      const microtin_segment middle = at(box.x + 1, box.y + 1);
      const bool fits = sizes[tile] <= (size + 7) / 8 * 8;
      CHECK(device.load(card, middle) == (fits ? MICROTIN_STATUS_OK : MICROTIN_STATUS_BAD_TILES));
      CHECK(why_bad(device, tile) == (fits ? MICROTIN_STATUS_OK : MICROTIN_STATUS_TOO_BIG));
    }
  }
}

TEST_CASE("compact pack: a tile that takes more than the header states breaks a rule") {
  Bytes bytes = rough_pack();
  const PackFile pack(bytes);
  const uint32_t needed = pack.header().compact_bytes;
  const auto refused = [&](uint32_t stated) {
    put_number(bytes, 32, stated, 4);
    repair_checks(bytes);
    Card card{bytes};
    const CompactSlots device(4);
    uint32_t count = 0;
    for (uint32_t tile = 0; tile < pack.entries().size(); ++tile) {
      const TileBox box = tile_box(pack.grid(), tile);
      device.load(card, at(box.x + 1, box.y + 1));
      const microtin_status why = why_bad(device, tile);
      CHECK((why == MICROTIN_STATUS_OK || why == MICROTIN_STATUS_MALFORMED));
      count += why == MICROTIN_STATUS_MALFORMED ? 1u : 0u;
    }
    return count;
  };
  CHECK(refused(needed) == 0);
  CHECK(refused(needed - 1) == 1);
  CHECK(refused(1) == pack.entries().size());
  CHECK(refused(0) == 0);  // not stated
}

TEST_CASE("compact pack: each form's functions refuse packs of the other") {
  Card card{rough_pack()};
  const MeshSlots mesh(1);
  const CompactSlots compact(1);
  const microtin_segment c = at(3, 3);
  REQUIRE(mesh.load(card, c) == MICROTIN_STATUS_OK);
  REQUIRE(compact.load(card, c) == MICROTIN_STATUS_OK);
  uint32_t hint = 0;
  int32_t height = 0;
  const microtin_grid_spec grid = {c.x, c.y, 1, 1, 1, 1, -1};
  int16_t sample = 0;
  CHECK(microtin_pack_height_at(compact.pack, c.x, c.y, &hint, &height) ==
        MICROTIN_QUERY_WRONG_PACK_KIND);
  microtin_segment_extremes extremes;
  CHECK(microtin_pack_segment_extremes(compact.pack, &c, &extremes) ==
        MICROTIN_QUERY_WRONG_PACK_KIND);
  CHECK(microtin_pack_sample_grid(compact.pack, &grid, &sample) == MICROTIN_QUERY_WRONG_PACK_KIND);
  CHECK(microtin_compact_pack_height_at(mesh.pack, c.x, c.y, &hint, &height) ==
        MICROTIN_QUERY_WRONG_PACK_KIND);
  CHECK(microtin_compact_pack_segment_extremes(mesh.pack, &c, &extremes) ==
        MICROTIN_QUERY_WRONG_PACK_KIND);
  CHECK(microtin_compact_pack_sample_grid(mesh.pack, &grid, &sample) ==
        MICROTIN_QUERY_WRONG_PACK_KIND);
  CHECK(microtin_pack_load(compact.pack, &c, 0) == MICROTIN_STATUS_WRONG_PACK_KIND);
  CHECK(microtin_compact_pack_load(mesh.pack, &c, 0) == MICROTIN_STATUS_WRONG_PACK_KIND);
  CHECK(microtin_compact_pack_load(nullptr, &c, 0) == MICROTIN_STATUS_ARGUMENT);
}

TEST_CASE("compact pack: the other form's load refuses at any moment, and nothing is lost") {
  Card card{rough_pack()};
  const PackFile pack(card.bytes);
  const microtin_segment c = at(3, 3);
  bool is_there = false;
  uint32_t refused = 0;
  for (int calls = 0; !is_there; ++calls) {
    const CompactSlots device(1);
    for (int i = 0; i < calls && !is_there; ++i) {
      is_there = device.load(card, c, 1) == MICROTIN_STATUS_OK;
    }
    REQUIRE(microtin_pack_load(device.pack, &c, 0) == MICROTIN_STATUS_WRONG_PACK_KIND);
    ++refused;
    REQUIRE(device.load(card, c) == MICROTIN_STATUS_OK);
    int32_t height = 0;
    CHECK(device.height_at(c.x, c.y, height) == MICROTIN_QUERY_OK);
    CHECK(height == *expected_height(pack, c.x, c.y));
  }
  CHECK(refused > 30);
}

TEST_CASE("compact pack: workspaces and arguments") {
  microtin_pack* pack = nullptr;
  Workspace space(MICROTIN_COMPACT_PACK_BYTES(3, 50, 600));
  const auto init = [&](size_t size, uint32_t slots, uint32_t capacity, uint32_t bytes) {
    return microtin_compact_pack_init(space.begin(), size, slots, capacity, bytes, &pack);
  };
  CHECK(init(space.size(), 3, 50, 600) == MICROTIN_STATUS_OK);
  CHECK(init(space.size(), 3, 50, 1100) == MICROTIN_STATUS_WORKSPACE_TOO_SMALL);
  CHECK(init(space.size(), 3, 500, 600) == MICROTIN_STATUS_WORKSPACE_TOO_SMALL);
  CHECK(init(space.size(), 3, 50, 0xFFFFFFFF) == MICROTIN_STATUS_WORKSPACE_TOO_SMALL);
  for (const uint32_t slots : {0u, 256u}) {
    pack = reinterpret_cast<microtin_pack*>(space.begin());
    CHECK(init(space.size(), slots, 50, 600) == MICROTIN_STATUS_ARGUMENT);
    CHECK(pack == nullptr);
  }
  CHECK(init(space.size(), 3, 2, 600) == MICROTIN_STATUS_ARGUMENT);
  CHECK(init(100, 1, 50, 600) == MICROTIN_STATUS_WORKSPACE_TOO_SMALL);
}

}  // namespace microtin::tests
