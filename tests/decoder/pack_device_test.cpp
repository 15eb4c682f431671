// SPDX-License-Identifier: MIT
// A device reads a pack: slots, segments, queries, and storage that fails in every way.
#include "tests/support/pack_device.hpp"

#include <doctest/doctest.h>
#include <sys/time.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "microtin/compact_pack.hpp"
#include "tests/support/forged_pack.hpp"
#include "tests/support/packs.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/slow.hpp"

namespace microtin::tests {
namespace {

// A height in whole units by 128-bit numbers.
int64_t in_units(int32_t z, const microtin_axis& axis) {
  const Wide real = static_cast<Wide>(axis.numerator) * z + Wide{axis.offset} * 65536;
  const Wide height = round_divide(real, static_cast<Wide>(axis.denominator) * 65536);
  return static_cast<int64_t>(std::clamp<Wide>(height, INT16_MIN, INT16_MAX));
}

microtin_segment segment(Random& random, int64_t x_max, int64_t y_max) {
  const auto pick = [&](int64_t most) {
    return static_cast<int64_t>(random.below(static_cast<uint32_t>(most * 256 + 1)));
  };
  return {pick(x_max), pick(y_max), pick(x_max), pick(y_max)};
}

}  // namespace

TEST_CASE_TEMPLATE("pack: heights at every position are those of the tiles, voids are reported" *
                       kSlow,
                   Device, MeshSlots, CompactSlots) {
  for (const VoidKind& kind : void_kinds()) {
    if (kind.name == "chessboard" || kind.name == "30 of 100") continue;  // many tiles
    CAPTURE(kind.name);
    Card card{pack_bytes(rough_raster(61, 53, kind.at))};
    const PackFile pack(card.bytes);
    const Device device(4);
    Random random(5);
    for (int i = 0; i < tried(60); ++i) {
      const microtin_segment c = segment(random, 60, 52);
      const int64_t x = i % 2 == 0 ? c.x : c.x / 256 * 256, y = i % 3 == 0 ? c.y / 256 * 256 : c.y;
      REQUIRE(device.load(card, {x, y, x, y}) == MICROTIN_STATUS_OK);
      int32_t height = 0;
      const microtin_query_result answer = device.height_at(x, y, height);
      const std::optional<int32_t> expected = expected_height(pack, x, y);
      CHECK(answer == (expected ? MICROTIN_QUERY_OK : MICROTIN_QUERY_VOID));
      if (expected) CHECK(height == *expected);
    }
    int32_t height = 0;
    CHECK(device.height_at(-1, 0, height) == MICROTIN_QUERY_OUTSIDE);
    CHECK(device.height_at(60 * 256 + 1, 0, height) == MICROTIN_QUERY_OUTSIDE);
  }
}

TEST_CASE_TEMPLATE("pack: tiles that are there need no reading, the least recently wanted goes",
                   Device, MeshSlots, CompactSlots) {
  Card card{pack_bytes(rough_raster(61, 53))};
  const PackFile pack(card.bytes);
  const TileGrid& grid = pack.grid();
  REQUIRE(tile_columns(grid) >= 3);
  const Device device(2);
  const auto middle_of = [&](int64_t column) {
    return at(column * grid.width + grid.width / 2, grid.height / 2);
  };
  int32_t height = 0;
  CHECK(device.height_at(0, 0, height) == MICROTIN_QUERY_NOT_LOADED);
  REQUIRE(device.load(card, middle_of(0)) == MICROTIN_STATUS_OK);
  REQUIRE(device.load(card, middle_of(1)) == MICROTIN_STATUS_OK);
  const uint32_t reads = card.reads;
  REQUIRE(device.load(card, middle_of(0)) == MICROTIN_STATUS_OK);
  CHECK(card.reads == reads);
  REQUIRE(device.load(card, middle_of(2)) == MICROTIN_STATUS_OK);  // in the place of 1
  const auto is_there = [&](int64_t column) {
    const microtin_segment c = middle_of(column);
    return device.height_at(c.x, c.y, height) == MICROTIN_QUERY_OK;
  };
  CHECK(is_there(0));
  CHECK(!is_there(1));
  CHECK(is_there(2));
  const microtin_segment corner = at(grid.width, grid.height);
  CHECK(device.load(card, corner) == MICROTIN_STATUS_WORKSPACE_TOO_SMALL);
  microtin_pack_reset(device.pack);
  CHECK(!is_there(0));
}

TEST_CASE_TEMPLATE("pack: steps and reads of a call are bounded, and queries work between", Device,
                   MeshSlots, CompactSlots) {
  Card card{pack_bytes(rough_raster(61, 53))};
  card.most = 7;
  const Device device(4);
  const microtin_segment c = at(30, 26);
  microtin_status status = MICROTIN_STATUS_STEP_LIMIT;
  uint32_t calls = 0;
  for (; status != MICROTIN_STATUS_OK && calls < 100000; ++calls) {
    const uint32_t reads = card.reads;
    status = device.load(card, c, 1);
    REQUIRE(card.reads <= reads + 1);
    REQUIRE((status == MICROTIN_STATUS_OK || status == MICROTIN_STATUS_NEED_INPUT ||
             status == MICROTIN_STATUS_STEP_LIMIT));
    int32_t height = 0;
    const microtin_query_result answer = device.height_at(c.x, c.y, height);
    REQUIRE(answer ==
            (status == MICROTIN_STATUS_OK ? MICROTIN_QUERY_OK : MICROTIN_QUERY_NOT_LOADED));
  }
  CHECK(status == MICROTIN_STATUS_OK);
  CHECK(calls > 50);
}

TEST_CASE_TEMPLATE("pack: segments that are loaded in turn, in pieces, all get their tiles", Device,
                   MeshSlots, CompactSlots) {
  Card card{pack_bytes(rough_raster(61, 53))};
  const PackFile pack(card.bytes);
  const TileGrid& grid = pack.grid();
  const microtin_segment segments[] = {
      at(1, 1),
      at(grid.x_max, grid.y_max),
      {0, grid.y_max * int64_t{256}, grid.x_max * int64_t{256}, grid.y_max * int64_t{256}}};
  for (const size_t most : {size_t{7}, size_t{1000}}) {
    card.most = most;
    const Device device(tile_columns(grid) + 1);
    bool is_there[3] = {};
    for (uint32_t call = 0; call < 20000; ++call) {
      const microtin_status status = device.load(card, segments[call % 3], 3);
      is_there[call % 3] = status == MICROTIN_STATUS_OK;
      if (is_there[0] && is_there[1] && is_there[2]) break;
      REQUIRE((status == MICROTIN_STATUS_OK || status == MICROTIN_STATUS_NEED_INPUT ||
               status == MICROTIN_STATUS_STEP_LIMIT));
    }
    CHECK((is_there[0] && is_there[1] && is_there[2]));
  }
}

// A card of which a tile's stream cannot be read any more.
struct WornCard {
  Card card;
  PackEntry worn;

  static int32_t read(void* context, uint64_t offset, uint8_t* buffer, size_t size) {
    WornCard& self = *static_cast<WornCard*>(context);
    const bool is_before = offset + size <= self.worn.offset;
    if (!is_before && offset < self.worn.offset + self.worn.size) return -1;
    return Card::read(&self.card, offset, buffer, size);
  }
};

TEST_CASE_TEMPLATE("pack: a tile in hand that cannot be read stops no other segment", Device,
                   MeshSlots, CompactSlots) {
  Card card{pack_bytes(rough_raster(61, 53))};
  const PackFile pack(card.bytes);
  const microtin_segment here = at(1, 1), there = at(pack.grid().x_max, pack.grid().y_max);
  WornCard worn{{card.bytes}, pack.entries().back()};
  uint32_t calls = 0;
  for (;; ++calls) {
    const Device device(2);
    microtin_status status = MICROTIN_STATUS_NEED_INPUT;
    for (uint32_t call = 0; call < calls; ++call) status = device.load(card, there, 5);
    if (status == MICROTIN_STATUS_OK) break;
    CHECK(device.load_with(here, WornCard::read, &worn, 0) == MICROTIN_STATUS_OK);
  }
  CHECK(calls > 10);
}

TEST_CASE_TEMPLATE("pack: every read fails in turn, and the next call goes on", Device, MeshSlots,
                   CompactSlots) {
  Card card{pack_bytes(rough_raster(61, 53))};
  const microtin_segment c = at(30, 26);
  uint32_t all = 0;
  {
    const Device device(4);
    REQUIRE(device.load(card, c) == MICROTIN_STATUS_OK);
    all = card.reads;
  }
  for (uint32_t failing = 0; failing < all; ++failing) {
    const Device device(4);
    card.reads = 0;
    card.failing = failing;
    CHECK(device.load(card, c) == MICROTIN_STATUS_IO);
    CHECK(card.reads == failing + 1);
    int32_t height = 0;
    CHECK(device.height_at(c.x, c.y, height) == MICROTIN_QUERY_NOT_LOADED);
    CHECK(device.load(card, c) == MICROTIN_STATUS_OK);
    CHECK(card.reads == all + 1);  // only what failed is read again
    CHECK(device.height_at(c.x, c.y, height) == MICROTIN_QUERY_OK);
  }
}

TEST_CASE_TEMPLATE(
    "pack: a removed card is reported at once, at any moment, and its return is enough", Device,
    MeshSlots, CompactSlots) {
  Card card{pack_bytes(rough_raster(61, 53))};
  const microtin_segment c = at(30, 26);
  for (uint32_t pulled = 0; pulled < 100; ++pulled) {
    const Device device(4);
    card.is_pulled = false;
    microtin_status status = MICROTIN_STATUS_NEED_INPUT;
    for (uint32_t call = 0; call < pulled && status != MICROTIN_STATUS_OK; ++call) {
      status = device.load(card, c, 5);
    }
    if (status == MICROTIN_STATUS_OK) break;
    card.is_pulled = true;
    for (int call = 0; call < 100; ++call) {
      status = device.load(card, c, 5);
      if (status == MICROTIN_STATUS_IO || status == MICROTIN_STATUS_OK) break;
      REQUIRE(status == MICROTIN_STATUS_STEP_LIMIT);  // it needs no bytes yet
    }
    if (status == MICROTIN_STATUS_OK) break;
    CHECK(status == MICROTIN_STATUS_IO);
    CHECK(device.load(card, c, 5) == MICROTIN_STATUS_IO);
    CHECK(device.load(card, c) == MICROTIN_STATUS_IO);
    card.is_pulled = false;
    CHECK(device.load(card, c) == MICROTIN_STATUS_OK);
  }
}

TEST_CASE_TEMPLATE("pack: who puts bytes there by hand tells the same", Device, MeshSlots,
                   CompactSlots) {
  const Bytes bytes = pack_bytes(rough_raster(61, 53));
  const Device device(4);
  const microtin_segment c = at(30, 26);
  uint64_t offset = 0;
  uint8_t* buffer = nullptr;
  size_t size = 0;
  microtin_pack_next_read(device.pack, &offset, &buffer, &size);
  REQUIRE(size == kPackFixedBytes);
  CHECK(device.load_without_reading(c, 0) == MICROTIN_STATUS_NEED_INPUT);  // nothing is said yet
  microtin_pack_complete_read(device.pack, -7);
  CHECK(device.load_without_reading(c, 0) == MICROTIN_STATUS_IO);
  CHECK(device.load_without_reading(c, 0) == MICROTIN_STATUS_NEED_INPUT);    // told once
  microtin_pack_complete_read(device.pack, static_cast<int32_t>(size) + 1);  // more than was wanted
  CHECK(device.load_without_reading(c, 0) == MICROTIN_STATUS_IO);
  std::copy_n(bytes.begin(), 9, buffer);
  microtin_pack_complete_read(device.pack, 9);
  microtin_pack_next_read(device.pack, &offset, &buffer, &size);
  CHECK(offset == 9);
  CHECK(size == kPackFixedBytes - 9);
  microtin_pack_complete_read(device.pack, 0);
  CHECK(device.load_without_reading(c, 0) == MICROTIN_STATUS_TRUNCATED);
  microtin_pack_next_read(device.pack, &offset, &buffer, &size);
  CHECK(offset == 0);  // anew
  microtin_status status = MICROTIN_STATUS_NEED_INPUT;
  for (int i = 0; i < 1000 && status == MICROTIN_STATUS_NEED_INPUT; ++i) {
    microtin_pack_next_read(device.pack, &offset, &buffer, &size);
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset), size, buffer);
    microtin_pack_complete_read(device.pack, static_cast<int32_t>(size));
    status = device.load_without_reading(c, 0);
  }
  CHECK(status == MICROTIN_STATUS_OK);
  microtin_pack_next_read(device.pack, &offset, &buffer, &size);
  CHECK(size == 0);
  microtin_pack_complete_read(device.pack, 0);  // nothing was wanted: nothing is heard
  CHECK(device.load_without_reading(c, 0) == MICROTIN_STATUS_OK);
}

namespace {

// What a handler of interrupts asks, and how often it was right.
struct Interrupted {
  const PackDevice* device;
  int64_t x, y;
  int32_t expected;
  volatile uint32_t right, absent, wrong;
} interrupted;

void ask_in_interrupt(int) {
  int32_t height = 0;
  const microtin_query_result answer =
      interrupted.device->height_at(interrupted.x, interrupted.y, height);
  if (answer == MICROTIN_QUERY_NOT_LOADED) {
    interrupted.absent = interrupted.absent + 1;
  } else if (answer == MICROTIN_QUERY_OK && height == interrupted.expected) {
    interrupted.right = interrupted.right + 1;
  } else {
    interrupted.wrong = interrupted.wrong + 1;
  }
}

}  // namespace

TEST_CASE_TEMPLATE("pack: a query in an interrupt is right at any moment of the service", Device,
                   MeshSlots, CompactSlots) {
  Card card{pack_bytes(rough_raster(61, 53))};
  const PackFile pack(card.bytes);
  const Device device(1);
  const TileGrid& grid = pack.grid();
  const int64_t x = grid.width * 128 + 5, y = grid.height * 128 + 9;  // in the first tile
  interrupted = {&device, x, y, *expected_height(pack, x, y), 0, 0, 0};
  struct sigaction action = {}, before = {};
  action.sa_handler = ask_in_interrupt;
  REQUIRE(sigaction(SIGALRM, &action, &before) == 0);
  const itimerval often{{0, 50}, {0, 50}}, never{{0, 0}, {0, 0}};
  setitimer(ITIMER_REAL, &often, nullptr);
  bool done = true;
  for (int round = 0; round < 3000 && interrupted.right + interrupted.absent < 2000; ++round) {
    // The first tile comes and goes.
    done = done && device.load(card, {x, y, x, y}) == MICROTIN_STATUS_OK;
    done = done && device.load(card, {3 * x, y, 3 * x, y}) == MICROTIN_STATUS_OK;
  }
  setitimer(ITIMER_REAL, &never, nullptr);
  sigaction(SIGALRM, &before, nullptr);
  CHECK(done);
  CHECK(interrupted.wrong == 0);
  CHECK(interrupted.right > 0);
  CHECK(interrupted.absent > 0);
}

TEST_CASE_TEMPLATE("pack: too small slots, workspaces and wrong arguments", Device, MeshSlots,
                   CompactSlots) {
  Card card{pack_bytes(rough_raster(61, 53))};
  const Device device(4, 10);
  CHECK(device.load(card, at(1, 1)) == MICROTIN_STATUS_BAD_TILES);
  CHECK(why_bad(device, 0) == MICROTIN_STATUS_TOO_BIG);
  CHECK(device.load(card, {0, 0, int64_t{1} << 24, 0}) == MICROTIN_STATUS_ARGUMENT);
  CHECK(device.load(card, {int64_t{1} << 41, 0, int64_t{1} << 41, 0}) == MICROTIN_STATUS_ARGUMENT);
  CHECK(device.load(card, at(-500, 9999)) == MICROTIN_STATUS_OK);  // no tile is there
  microtin_pack* pack = nullptr;
  Workspace space(MICROTIN_PACK_BYTES(3, 50));
  CHECK(microtin_pack_init(space.begin(), space.size(), 3, 50, nullptr) ==
        MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_pack_init(space.begin(), space.size(), 0, 50, &pack) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_pack_init(space.begin(), space.size(), 3, 500, &pack) ==
        MICROTIN_STATUS_WORKSPACE_TOO_SMALL);
  CHECK(microtin_pack_init(static_cast<char*>(space.begin()) + 1, space.size() - 1, 1, 50, &pack) ==
        MICROTIN_STATUS_MISALIGNED);
  CHECK(microtin_pack_init(space.begin(), space.size(), 3, 50, &pack) == MICROTIN_STATUS_OK);
}

TEST_CASE_TEMPLATE("pack: the highest on a segment is that of its edges and no sample is above" *
                       kSlow,
                   Device, MeshSlots, CompactSlots) {
  for (const VoidKind& kind : void_kinds()) {
    if (kind.name == "chessboard" || kind.name == "30 of 100") continue;
    CAPTURE(kind.name);
    Card card{pack_bytes(rough_raster(61, 53, kind.at))};
    const SurfaceModel model = model_of(PackFile(card.bytes));
    const Device device(60);
    Random random(7);
    for (int i = 0; i < tried(40); ++i) {
      microtin_segment c = segment(random, 60, 52);
      if (i % 4 == 0) c.x_end = c.x = c.x / 256 * 256;  // along posts, maybe a border
      if (i % 4 == 1)
        c = {c.x / 256 * 256, c.y / 256 * 256, c.x_end / 256 * 256, c.y_end / 256 * 256};
      REQUIRE(device.load(card, c) == MICROTIN_STATUS_OK);
      int32_t highest = 0;
      const microtin_query_result answer = device.highest_on(c, &highest);
      int32_t sampled = INT32_MIN, begin = INT32_MIN, end = INT32_MIN;
      bool gap = false;
      for (int64_t k = 0; k <= 4096; ++k) {  // those that lie on the segment exactly
        const int64_t dx = (c.x_end - c.x) * k, dy = (c.y_end - c.y) * k;
        if (dx % 4096 != 0 || dy % 4096 != 0) continue;
        int32_t height = INT32_MIN;
        const microtin_query_result here =
            device.height_at(c.x + dx / 4096, c.y + dy / 4096, height);
        if (here == MICROTIN_QUERY_OK) sampled = std::max(sampled, height);
        gap = gap || here == MICROTIN_QUERY_VOID;
      }
      device.height_at(c.x, c.y, begin);
      device.height_at(c.x_end, c.y_end, end);
      const double exact = std::max({highest_on_edges(model, c) * 65536, begin * 1.0, end * 1.0});
      if (exact > INT32_MIN) CHECK(std::abs(highest - exact) < 1);
      CHECK(highest >= sampled);
      if (gap) CHECK(answer == MICROTIN_QUERY_VOID);
      if (kind.name == "none") CHECK(answer == MICROTIN_QUERY_OK);
    }
  }
}

TEST_CASE_TEMPLATE("pack: a block of heights in whole units", Device, MeshSlots, CompactSlots) {
  Card card{pack_bytes(rough_raster(61, 53, void_kinds()[2].at))};
  const Device device(60);
  REQUIRE(device.load(card, {0, 0, 60 * 256, 52 * 256}) == MICROTIN_STATUS_OK);
  REQUIRE(device.load(card, {0, 52 * 256, 60 * 256, 0}) == MICROTIN_STATUS_OK);
  microtin_pack_info info;
  REQUIRE(microtin_pack_get_info(device.pack, &info) == MICROTIN_STATUS_OK);
  const microtin_grid_spec block{5 * 256, 3 * 256, 512, 384, 20, 25, -999};
  std::vector<int16_t> heights(500);
  const microtin_query_result answer = device.sample_grid(block, heights.data());
  CHECK(answer != MICROTIN_QUERY_OK);
  for (int64_t i = 0; i < 500; ++i) {
    int32_t z = 0;
    const microtin_query_result here =
        device.height_at(block.x + i % 20 * 512, block.y + i / 20 * 384, z);
    const int16_t found = heights[static_cast<size_t>(i)];
    CHECK(found == (here == MICROTIN_QUERY_OK ? in_units(z, info.z) : -999));
  }
}

TEST_CASE_TEMPLATE(
    "pack: heights of a block are rounded to nearest, halves up, and kept within 16 bits", Device,
    MeshSlots, CompactSlots) {
  const auto fill = [](const Axis& axis, int16_t west, int16_t east) {
    Metadata metadata;
    metadata.placement.z = axis;
    Card card{forged_pack(
        {4, 4, 4, 4}, {forged_tile({{{0, 0, west}, {4, 0, east}, {0, 4, west}, {4, 4, east}}, {}})},
        metadata)};
    const Device device(1);
    REQUIRE(device.load(card, at(1, 1)) == MICROTIN_STATUS_OK);
    microtin_pack_info info;
    REQUIRE(microtin_pack_get_info(device.pack, &info) == MICROTIN_STATUS_OK);
    std::vector<int16_t> heights(257);
    const microtin_grid_spec block{0, 128, 4, 0, 257, 1, 0};
    REQUIRE(device.sample_grid(block, heights.data()) == MICROTIN_QUERY_OK);
    for (int64_t i = 0; i < 257; ++i) {
      int32_t z = 0;
      REQUIRE(device.height_at(4 * i, 128, z) == MICROTIN_QUERY_OK);
      CHECK(heights[static_cast<size_t>(i)] == in_units(z, info.z));
    }
    return std::make_pair(heights.front(), heights.back());
  };
  using Ends = std::pair<int16_t, int16_t>;
  CHECK(fill({0, 1, 1}, -100, 100) == Ends(-100, 100));
  CHECK(fill({0, 1, 2}, -3, 3) == Ends(-1, 2));
  CHECK(fill({0, 10, 1}, -32768, 32767) == Ends(-32768, 32767));
  CHECK(fill({32767, 1, 1}, 0, 1) == Ends(32767, 32767));
  CHECK(fill({-32768, 1, 1}, -1, 0) == Ends(-32768, -32768));
  CHECK(fill({-32770, 3, 1}, -1, 1) == Ends(-32768, -32767));
  const int64_t far = int64_t{1} << 45;
  CHECK(fill({far, 1, 1}, 0, 1) == Ends(32767, 32767));
  CHECK(fill({-far, (1u << 31) - 1, 1}, 0, 1) == Ends(-32768, -32768));
  CHECK(fill({far - 7, 1, (int64_t{1} << 40) - 1}, -32768, 32767) == Ends(32, 32));
}

TEST_CASE_TEMPLATE(
    "pack: a block tells the last reason, or that a tile is missing, and needs a header", Device,
    MeshSlots, CompactSlots) {
  Card card{forged_pack({8, 4, 4, 4}, {forged_tile({{{0, 0, 1}, {4, 0, 2}, {0, 4, 3}}, {}}), {}})};
  const Device device(2);
  std::vector<int16_t> heights(3);
  const auto fill = [&](int64_t x, int64_t y, int32_t dx, uint16_t columns) {
    std::fill(heights.begin(), heights.end(), int16_t{0});
    const microtin_grid_spec block{x * 256, y * 256, dx * 256, 0, columns, 1, -9};
    return device.sample_grid(block, heights.data());
  };
  const std::vector<int16_t> missing{-9, -9, -9}, untouched{0, 0, 0};
  CHECK(fill(1, 1, 1, 3) == MICROTIN_QUERY_NOT_LOADED);
  CHECK(heights == missing);
  REQUIRE(device.load(card, at(1, 1)) == MICROTIN_STATUS_OK);
  CHECK(fill(0, 0, 1, 3) == MICROTIN_QUERY_OK);
  CHECK(heights == std::vector<int16_t>{1, 1, 2});
  CHECK(fill(-3, 3, 6, 2) == MICROTIN_QUERY_VOID);  // outside, void
  CHECK(fill(3, 3, -6, 2) == MICROTIN_QUERY_OUTSIDE);
  CHECK(fill(-3, 3, 4, 2) == MICROTIN_QUERY_OUTSIDE);  // outside, a height
  CHECK(fill(5, 1, 4, 2) == MICROTIN_QUERY_NOT_LOADED);
  CHECK(heights[0] == -9);
  CHECK(fill(-3, 1, 9, 2) == MICROTIN_QUERY_NOT_LOADED);
  CHECK(fill((int64_t{1} << 32) + 1, 1, 1, 3) == MICROTIN_QUERY_OUTSIDE);
  CHECK(heights == untouched);
}

TEST_CASE("pack: real coordinates become places, exactly rounded") {
  Random random(9);
  uint32_t inside = 0;
  for (int i = 0; i < 20000; ++i) {
    const uint32_t shift = random.below(30), depth = random.below(40);
    const microtin_axis axis = {static_cast<int64_t>(random.below(1u << 31)) - (1 << 30),
                                1 + random.below(1u << shift),
                                1 + (uint64_t{random.below(1u << 30)} << 10 >> (39 - depth))};
    const uint32_t most = random.below(1u << 31), per_unit = 1 + random.below(1u << 24);
    // A value near a random place.
    const Wide place = random.below(1u << 31) >> random.below(31);
    const Wide near = (axis.offset + static_cast<Wide>(axis.numerator) * place) * per_unit /
                      static_cast<Wide>(axis.denominator);
    const Wide value = near + random.below(1000);
    if (magnitude(value) >> 62 != 0) continue;
    const Wide numerator = static_cast<Wide>(value) * static_cast<Wide>(axis.denominator) -
                           static_cast<Wide>(axis.offset) * per_unit;
    const Wide step = static_cast<Wide>(axis.numerator) * per_unit;
    const Wide expected = round_divide(numerator * 256, step);
    const bool outside = numerator < 0 || expected > Wide{most} * 256;
    int64_t lattice = 0;
    const microtin_status status =
        microtin_pack_axis_to_lattice(&axis, most, static_cast<int64_t>(value), per_unit, &lattice);
    CHECK(status == (outside ? MICROTIN_STATUS_OUT_OF_RANGE : MICROTIN_STATUS_OK));
    if (!outside) CHECK(lattice == static_cast<int64_t>(expected));
    inside += outside ? 0u : 1u;
  }
  CHECK(inside > 5000);
  const microtin_axis degrees = {7 * 1200, 1, 1200};
  int64_t lattice = 0;
  CHECK(microtin_pack_axis_to_lattice(&degrees, 1200, 75000000, 10000000, &lattice) ==
        MICROTIN_STATUS_OK);
  CHECK(lattice == 600 * 256);
  CHECK(microtin_pack_axis_to_lattice(&degrees, 1200, 69999999, 10000000, &lattice) ==
        MICROTIN_STATUS_OUT_OF_RANGE);
  CHECK(microtin_pack_axis_to_lattice(&degrees, 1200, INT64_MAX, 1, &lattice) ==
        MICROTIN_STATUS_OUT_OF_RANGE);
  CHECK(microtin_pack_axis_to_lattice(&degrees, 1200, INT64_MIN, 1, &lattice) ==
        MICROTIN_STATUS_OUT_OF_RANGE);
  CHECK(microtin_pack_axis_to_lattice(&degrees, 1200, 0, 0, &lattice) ==
        MICROTIN_STATUS_OUT_OF_RANGE);
}

using MeshPack = Pack<4, kCapacity>;
using PackOfCompact = CompactPack<4, kCapacity>;

TEST_CASE_TEMPLATE("pack: the C++ face", Face, MeshPack, PackOfCompact) {
  static Face pack;
  Card card{pack_bytes(rough_raster(61, 53))};
  const microtin_segment c = at(30, 26);
  microtin_pack_info info;
  CHECK(pack.get_info(&info) != MICROTIN_STATUS_OK);
  REQUIRE(pack.load_with(c, Card::read, &card, 0) == MICROTIN_STATUS_OK);
  REQUIRE(pack.get_info(&info) == MICROTIN_STATUS_OK);
  CHECK(info.x_max == 60);
  uint32_t hint = 0;
  int32_t height = 0;
  microtin_segment_extremes found;
  CHECK(pack.height_at(c.x, c.y, &hint, &height) == MICROTIN_QUERY_OK);
  CHECK(pack.segment_extremes(c, &found) == MICROTIN_QUERY_OK);
  CHECK(found.highest == height);
  CHECK(found.lowest == height);
  int16_t rounded = 0;
  CHECK(pack.sample_grid({c.x, c.y, 0, 0, 1, 1, -1}, &rounded) == MICROTIN_QUERY_OK);
  pack.reset();
  CHECK(pack.height_at(c.x, c.y, &hint, &height) == MICROTIN_QUERY_NOT_LOADED);
}

TEST_CASE_TEMPLATE("pack: far from the origin, in the largest extent", Device, MeshSlots,
                   CompactSlots) {
  // A header for 2^31 - 1 steps, with one known tile in the farthest corner.
  const EncodedPack encoded = encode_pack(rough_raster(31, 31), pack_options(2, 400));
  REQUIRE(encoded.streams.size() == 1);
  const TileGrid far{kPackExtentMost, kPackExtentMost, 65535, 65535};
  const uint64_t tiles = uint64_t{tile_columns(far)} * tile_rows(far);
  CHECK(tiles == uint64_t{32769} * 32769);
  // 28 GB of index: only the entry that is read is made.
  Bytes head = write_pack(encoded);
  const auto put = [&](size_t place, uint64_t value, int width) {
    for (int i = 0; i < width; ++i)
      head[place + static_cast<size_t>(i)] = static_cast<uint8_t>(value >> 8 * i);
  };
  const uint32_t index = pack_index_start(PackFile(head).header());
  put(10, 65535, 2);
  put(12, 65535, 2);
  put(20, kPackExtentMost, 4);
  put(24, kPackExtentMost, 4);
  put(index - 4, crc32(0, head.data(), index - 4), 4);
  const uint64_t streams = index + tiles * kPackEntryBytes;
  const uint32_t number = static_cast<uint32_t>(tiles - 1);
  put(index + kPackEntryBytes - kCheckBytes,
      pack_entry_check(read_u32(head.data() + 36), number, head.data() + index), 4);
  struct FarCard {
    Bytes bytes;
    uint64_t entry, index, streams;
    static int32_t read(void* context, uint64_t offset, uint8_t* buffer, size_t size) {
      const FarCard& card = *static_cast<FarCard*>(context);
      const uint64_t from = offset >= card.streams
                                ? offset - card.streams + card.index + kPackEntryBytes
                            : offset >= card.entry ? offset - card.entry + card.index
                                                   : offset;
      if (from >= card.bytes.size()) return 0;
      const size_t taken = std::min(size, card.bytes.size() - static_cast<size_t>(from));
      std::memcpy(buffer, card.bytes.data() + from, taken);
      return static_cast<int32_t>(taken);
    }
  } card{head, index + uint64_t{number} * kPackEntryBytes, index, streams};
  const Device device(4, 400);
  const int64_t corner = int64_t{32768} * 65535 * 256;
  const microtin_segment c{corner + 5 * 256, corner + 7 * 256, corner + 25 * 256, corner + 9 * 256};
  REQUIRE(device.load_with(c, FarCard::read, &card, 0) == MICROTIN_STATUS_OK);
  int32_t height = 0, highest = 0;
  CHECK(device.height_at(c.x, c.y, height) == MICROTIN_QUERY_OK);
  CHECK(height == *expected_height(PackFile(write_pack(encoded)), 5 * 256, 7 * 256));
  CHECK(device.highest_on(c, &highest) == MICROTIN_QUERY_OK);
  CHECK(highest >= height);
}

}  // namespace microtin::tests
