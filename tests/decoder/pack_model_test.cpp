// SPDX-License-Identifier: MIT
// Any sequence of calls on a pack, beside a model that knows nothing of sequences: what is said of
// a segment follows from the segment, the tiles that are bad and the number of slots.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/support/forged_pack.hpp"
#include "tests/support/pack_device.hpp"

namespace microtin::tests {
namespace {

constexpr uint32_t kTileSteps = 16, kFits = 40;
constexpr uint32_t kNever = ~0u;

enum class Kind { kSmall, kLarge, kNone, kWithNotes, kTooBig };

int32_t plane(int64_t x, int64_t y) {
  return static_cast<int32_t>(x + 3 * y);
}

// A tile on the plane, with so many vertices beside its corners.
Tin tile_on_plane(uint32_t column, uint32_t row, uint32_t inner) {
  Tin tin;
  const auto add = [&](uint32_t x, uint32_t y) {
    const int32_t z = plane(column * kTileSteps + x, row * kTileSteps + y);
    tin.vertices.push_back(
        {static_cast<uint16_t>(x), static_cast<uint16_t>(y), static_cast<int16_t>(z)});
  };
  for (const uint32_t y : {0u, kTileSteps}) {
    for (const uint32_t x : {0u, kTileSteps}) add(x, y);
  }
  for (uint32_t i = 0; i < inner; ++i) add(1 + i % 15, 1 + i / 15 * 2);
  return tin;
}

ForgedTile tile_of(Kind kind, uint32_t column, uint32_t row) {
  static std::map<std::array<uint32_t, 3>, ForgedTile> made;
  const std::array<uint32_t, 3> key = {static_cast<uint32_t>(kind), column, row};
  const auto found = made.find(key);
  if (found != made.end()) return found->second;
  const uint32_t inner = kind == Kind::kLarge ? kFits - 4 : kind == Kind::kTooBig ? 50 : 0;
  const Tin tin = tile_on_plane(column, row, inner);
  ForgedTile tile;
  if (kind == Kind::kWithNotes) {
    Metadata notes;
    notes.source = "here";
    tile = {encode(tin, notes), static_cast<uint32_t>(tin.vertices.size())};
  } else if (kind != Kind::kNone) {
    tile = forged_tile(tin);
  }
  return made[key] = tile;
}

using Reasons = std::set<microtin_status>;

// A pack of tiles of all kinds, some of them damaged, and why each is bad.
struct Model {
  uint32_t columns, rows;
  Bytes bytes;
  std::vector<Kind> kinds;
  std::vector<Reasons> reasons;  // empty: it is good

  uint32_t tiles() const { return columns * rows; }
  bool is_bad(uint32_t tile) const { return !reasons[tile].empty(); }
};

Kind some_kind(Random& random, uint32_t bad_of_100) {
  if (random.below(100) >= bad_of_100) {
    return random.below(8) == 0 ? Kind::kNone : random.below(2) == 0 ? Kind::kLarge : Kind::kSmall;
  }
  return random.below(2) == 0 ? Kind::kWithNotes : Kind::kTooBig;
}

Model some_model(Random& random) {
  Model model{random.below(2) == 0 ? 24u : 6u, 1, {}, {}, {}};
  model.rows = 24 / model.columns;
  const uint32_t bad_of_100 = 20 * random.below(5);
  std::vector<ForgedTile> tiles;
  for (uint32_t i = 0; i < model.tiles(); ++i) {
    const Kind kind = some_kind(random, bad_of_100 / 2);
    model.kinds.push_back(kind);
    tiles.push_back(tile_of(kind, i % model.columns, i / model.columns));
  }
  model.bytes = forged_pack(
      {model.columns * kTileSteps, model.rows * kTileSteps, kTileSteps, kTileSteps}, tiles);
  const PackFile file(model.bytes);
  size_t size = model.bytes.size();
  if (random.below(4) == 0) size -= random.below(static_cast<uint32_t>(size) - 600);
  for (uint32_t i = 0; i < model.tiles(); ++i) {
    const uint64_t entry = pack_entry_start(file.header(), i);
    const PackEntry& stream = file.entries()[i];
    const bool is_small = model.kinds[i] == Kind::kSmall;
    Reasons why;
    if (model.kinds[i] == Kind::kWithNotes) why.insert(MICROTIN_STATUS_MALFORMED);
    if (model.kinds[i] == Kind::kTooBig) why.insert(MICROTIN_STATUS_TOO_BIG);
    if (is_small && random.below(100) < bad_of_100) {
      model.bytes[static_cast<size_t>(stream.offset) + 20] ^= 1;
      why.insert(MICROTIN_STATUS_CHECKSUM);
    }
    if (stream.size != 0 && stream.offset + stream.size > size)
      why.insert(MICROTIN_STATUS_TRUNCATED);
    if (random.below(100) < bad_of_100 / 4) {
      model.bytes[static_cast<size_t>(entry) + random.below(kPackEntryBytes)] ^= 4;
      why = {MICROTIN_STATUS_CHECKSUM};
    }
    if (entry + kPackEntryBytes > size) why = {MICROTIN_STATUS_TRUNCATED};
    model.reasons.push_back(why);
  }
  model.bytes.resize(size);
  return model;
}

// Whether a segment meets the closed box of a tile: no line parallel to an axis, nor the segment
// itself, has the one on this side and the other beyond.
bool touches(const Model& model, const microtin_segment& c, uint32_t tile) {
  const int64_t side = kTileSteps * 256;
  const int64_t left = tile % model.columns * side, low = tile / model.columns * side;
  if (std::max(c.x, c.x_end) < left || std::min(c.x, c.x_end) > left + side) return false;
  if (std::max(c.y, c.y_end) < low || std::min(c.y, c.y_end) > low + side) return false;
  bool is_left = false, is_right = false;
  for (const int64_t x : {left, left + side}) {
    for (const int64_t y : {low, low + side}) {
      const int64_t turn = (c.x_end - c.x) * (y - c.y) - (c.y_end - c.y) * (x - c.x);
      is_left = is_left || turn >= 0;
      is_right = is_right || turn <= 0;
    }
  }
  return is_left && is_right;
}

std::vector<uint32_t> touched(const Model& model, const microtin_segment& segment) {
  std::vector<uint32_t> tiles;
  for (uint32_t i = 0; i < model.tiles(); ++i) {
    if (touches(model, segment, i)) tiles.push_back(i);
  }
  return tiles;
}

microtin_status verdict(const Model& model, const microtin_segment& segment, uint32_t slots) {
  uint32_t good = 0, bad = 0;
  for (const uint32_t tile : touched(model, segment)) ++(model.is_bad(tile) ? bad : good);
  return good > slots ? MICROTIN_STATUS_WORKSPACE_TOO_SMALL
         : bad != 0   ? MICROTIN_STATUS_BAD_TILES
                      : MICROTIN_STATUS_OK;
}

microtin_segment some_segment(Random& random, const Model& model) {
  const auto pick = [&](uint32_t tiles) {
    const int64_t step = random.below(3) == 0 ? kTileSteps : 1;
    return static_cast<int64_t>(random.below(tiles * kTileSteps + 1)) / step * step * 256;
  };
  microtin_segment c = {pick(model.columns), pick(model.rows), pick(model.columns),
                        pick(model.rows)};
  if (random.below(4) == 0) c = {c.x, c.y, c.x, c.y};
  return c;
}

// A card whose reads fail, are short and end where the pack does.
struct UnsteadyCard {
  const Bytes* bytes;
  Random random;
  uint32_t failing_of_100;
  bool has_failed = false;
  uint64_t unreadable = 0, unreadable_end = 0;
  uint32_t reads = 0;

  static int32_t read(void* context, uint64_t offset, uint8_t* buffer, size_t size) {
    UnsteadyCard& card = *static_cast<UnsteadyCard*>(context);
    if (++card.reads > 1000000) FAIL("one read too many");
    const bool meets = offset < card.unreadable_end && offset + size > card.unreadable;
    if (meets || card.random.below(100) < card.failing_of_100) {
      card.has_failed = true;
      return card.random.below(2) == 0 ? -1 : static_cast<int32_t>(size) + 1;
    }
    if (offset >= card.bytes->size()) return 0;
    size = std::min(size, card.bytes->size() - static_cast<size_t>(offset));
    if (card.random.below(3) == 0) size = 1 + card.random.below(static_cast<uint32_t>(size));
    std::copy_n(card.bytes->begin() + static_cast<std::ptrdiff_t>(offset), size, buffer);
    return static_cast<int32_t>(size);
  }
};

// A place in the middle of a tile.
void check_place(const PackDevice& device, const Model& model, uint32_t tile, bool must_be_there) {
  const int64_t x = (tile % model.columns * kTileSteps + 5) * 256 + 7,
                y = (tile / model.columns * kTileSteps + 9) * 256 + 100;
  int32_t height = 0;
  const microtin_query_result answer = device.height_at(x, y, height);
  if (answer == MICROTIN_QUERY_NOT_LOADED) {
    CHECK(!must_be_there);
  } else if (model.is_bad(tile)) {
    CHECK(answer == MICROTIN_QUERY_BAD_TILE);
  } else {
    CHECK(answer == (model.kinds[tile] == Kind::kNone ? MICROTIN_QUERY_VOID : MICROTIN_QUERY_OK));
    if (answer == MICROTIN_QUERY_OK) CHECK(height == plane(x, y) * 256);
  }
}

void check_bad_tiles(const PackDevice& device, const Model& model) {
  for (uint32_t i = 0; i < MICROTIN_PACK_MAX_BAD_TILES; ++i) {
    uint32_t tile = 0, why = MICROTIN_STATUS_OK;
    if (microtin_pack_bad_tile(device.pack, i, &tile, &why) != MICROTIN_STATUS_OK) continue;
    CHECK(model.reasons[tile].count(static_cast<microtin_status>(why)) == 1);
  }
}

// What a call says, beside the model. True if there is no more to do for the segment.
bool check_status(const PackDevice& device, const Model& model, uint32_t slots,
                  const microtin_segment& segment, microtin_status status, UnsteadyCard& card) {
  const bool has_failed = card.has_failed;
  card.has_failed = false;
  check_bad_tiles(device, model);
  if (status == MICROTIN_STATUS_NEED_INPUT || status == MICROTIN_STATUS_STEP_LIMIT) return false;
  if (status == MICROTIN_STATUS_IO) {
    CHECK(has_failed);
    return false;
  }
  CHECK(status == verdict(model, segment, slots));
  for (const uint32_t tile : touched(model, segment)) {
    check_place(device, model, tile,
                status != MICROTIN_STATUS_WORKSPACE_TOO_SMALL && !model.is_bad(tile));
  }
  return true;
}

constexpr uint32_t kLimits[] = {0, 1, 3, 50};

// A segment is served for a while, or to its end.
void serve_segment(const PackDevice& device, const Model& model, uint32_t slots,
                   const microtin_segment& segment, UnsteadyCard& card) {
  const bool to_the_end = card.random.below(2) == 0;
  const uint32_t most = to_the_end ? 20000 : 1 + card.random.below(60),
                 steps = kLimits[card.random.below(4)];
  bool is_over = false;
  for (uint32_t calls = 0; calls < most && !is_over; ++calls) {
    const microtin_status status = device.load_with(segment, UnsteadyCard::read, &card, steps);
    is_over = check_status(device, model, slots, segment, status, card);
  }
  if (to_the_end) CHECK(is_over);
}

template <class Device>
void run_sequence(uint32_t seed) {
  Random random(seed);
  const uint32_t slots = random.below(3) == 0 ? 1 : 1 + random.below(12);
  const Device device(slots, kFits);
  Model model = some_model(random);
  UnsteadyCard card{&model.bytes, Random(seed + 77), random.below(3) == 0 ? 10u : 0u};
  std::vector<microtin_segment> segments(3);
  for (microtin_segment& segment : segments) segment = some_segment(random, model);
  segments.push_back({segments[0].x_end, segments[0].y_end, segments[0].x, segments[0].y});
  for (int i = 0; i < 25; ++i) {
    const uint32_t what = random.below(20);
    if (what == 0) microtin_pack_clear_bad_tiles(device.pack);
    if (what == 1) microtin_pack_align_reads(device.pack, random.below(2) * 16u << random.below(6));
    if (what == 2) {  // another card, sometimes right after a read that failed or ended
      if (random.below(2) == 0)
        microtin_pack_complete_read(device.pack, static_cast<int32_t>(random.below(2)) - 1);
      model = some_model(random);
      microtin_pack_reset(device.pack);
    }
    microtin_segment& segment = segments[random.below(4)];
    if (random.below(4) == 0) segment = some_segment(random, model);
    serve_segment(device, model, slots, segment, card);
    check_place(device, model, random.below(model.tiles()), false);
  }
}

// A row of small tiles, of which those given are damaged, and one without terrain.
Model row_model(const std::vector<uint32_t>& damaged, uint32_t columns = 24, uint32_t none = kNever,
                const Metadata& metadata = {}) {
  Model model{columns, 1, {}, std::vector<Kind>(columns, Kind::kSmall), {}};
  if (none != kNever) model.kinds[none] = Kind::kNone;
  std::vector<ForgedTile> tiles;
  for (uint32_t i = 0; i < columns; ++i) tiles.push_back(tile_of(model.kinds[i], i, 0));
  model.bytes =
      forged_pack({columns * kTileSteps, kTileSteps, kTileSteps, kTileSteps}, tiles, metadata);
  model.reasons.resize(columns);
  const PackFile file(model.bytes);
  for (const uint32_t i : damaged) {
    model.bytes[static_cast<size_t>(file.entries()[i].offset) + 20] ^= 1;
    model.reasons[i].insert(MICROTIN_STATUS_CHECKSUM);
  }
  return model;
}

std::vector<uint32_t> numbers(uint32_t from, uint32_t to) {
  std::vector<uint32_t> all;
  for (; from < to; ++from) all.push_back(from);
  return all;
}

// From the middle of a tile of a row to that of another.
microtin_segment along(int64_t from, int64_t to) {
  const int64_t side = kTileSteps * 256;
  return {from * side + side / 2, 500, to * side + side / 2, 500};
}

// What is said of a segment in the end; NEED_INPUT if there is no end.
microtin_status served(const PackDevice& device, const microtin_segment& segment, uint32_t steps,
                       UnsteadyCard& card) {
  for (int calls = 0; calls < 20000; ++calls) {
    const microtin_status status = device.load_with(segment, UnsteadyCard::read, &card, steps);
    if (status != MICROTIN_STATUS_NEED_INPUT && status != MICROTIN_STATUS_STEP_LIMIT) return status;
  }
  return MICROTIN_STATUS_NEED_INPUT;
}

}  // namespace

TEST_CASE_TEMPLATE("pack: however many tiles are bad, the good ones come, with any number of slots",
                   Device, MeshSlots, CompactSlots) {
  for (uint32_t bad = 0; bad < 20; ++bad) {
    for (const uint32_t slots : {1u, 2u, 4u, 12u}) {
      CAPTURE(bad);
      CAPTURE(slots);
      // One good tile behind them, one in front, and as many as there are slots.
      const Model model = row_model(numbers(1, 1 + bad), 40);
      const Device device(slots, kFits);
      UnsteadyCard card{&model.bytes, Random(1), 0};
      const int64_t last = bad + 1;
      const auto check = [&](const microtin_segment& segment) {
        CHECK(served(device, segment, 0, card) == verdict(model, segment, slots));
        for (const uint32_t tile : touched(model, segment)) {
          if (verdict(model, segment, slots) != MICROTIN_STATUS_WORKSPACE_TOO_SMALL) {
            check_place(device, model, tile, !model.is_bad(tile));
          }
        }
      };
      check(along(1, last));
      check(along(last, 1));
      check(along(0, bad));
      check(along(bad, 0));
      check(along(0, last));
      check(along(1, last + slots - 1));
      check(along(last + slots - 1, 1));  // the bad ones come last
      check(along(1, last + slots));
      check(along(last + slots, 1));
    }
  }
}

TEST_CASE_TEMPLATE("pack: bad tiles stop no segment that moves with each call", Device, MeshSlots,
                   CompactSlots) {
  constexpr uint32_t kBad = 13;
  const Model model = row_model(numbers(0, kBad));
  for (const uint32_t slots : {1u, 4u}) {
    const Device device(slots, kFits);
    UnsteadyCard card{&model.bytes, Random(1), 0};
    microtin_segment segment = along(0, kBad);
    uint32_t calls = 0;
    int32_t height = 0;
    while (device.height_at(segment.x_end, 500, height) != MICROTIN_QUERY_OK && calls < 5000) {
      segment.x = 500 + calls++ % 7;
      const microtin_status status = device.load_with(segment, UnsteadyCard::read, &card, 1);
      CHECK((status == MICROTIN_STATUS_NEED_INPUT || status == MICROTIN_STATUS_STEP_LIMIT));
    }
    CHECK(calls < 5000);
  }
}

namespace {

// Each tile of a row in turn, while a sector cannot be read.
template <class Device>
void check_unreadable(const Model& model, uint32_t sector, uint64_t from, uint64_t to) {
  const PackFile file(model.bytes);
  const auto is_hit = [&](uint64_t at, uint64_t size) { return at < to && from < at + size; };
  UnsteadyCard card{&model.bytes, Random(from), 0};
  card.unreadable = from;
  card.unreadable_end = to;
  const Device device(2, kFits);
  CHECK(microtin_pack_align_reads(device.pack, sector) == MICROTIN_STATUS_OK);
  for (uint32_t tile = 0; tile < model.tiles(); ++tile) {
    const PackEntry& stream = file.entries()[tile];
    const bool is_lost = is_hit(pack_entry_start(file.header(), tile), kPackEntryBytes) ||
                         is_hit(stream.offset, stream.size);
    CHECK(served(device, along(tile, tile), 0, card) ==
          (is_lost ? MICROTIN_STATUS_IO : MICROTIN_STATUS_OK));
    check_place(device, model, tile, !is_lost);
  }
}

}  // namespace

TEST_CASE_TEMPLATE("pack: an unreadable part of the index hides no tile that another part lists",
                   Device, MeshSlots, CompactSlots) {
  for (size_t length = 0; length <= 16; length += 4) {
    Metadata notes;
    notes.source = std::string(length, 's');
    const Model model = row_model({}, 30, kNever, notes);
    const uint64_t index = pack_entry_start(PackFile(model.bytes).header(), 0);
    for (const uint32_t sector : {0u, 16u, 32u, 64u, 128u, 512u}) {
      const uint64_t size = sector == 0 ? 64 : sector;
      for (uint64_t from = (index / size + 1) * size; from < model.bytes.size(); from += size) {
        check_unreadable<Device>(model, sector, from, from + size);
      }
    }
  }
}

TEST_CASE_TEMPLATE("pack: tiles that are repaired come once the caller says so, at any moment",
                   Device, MeshSlots, CompactSlots) {
  constexpr uint32_t kBad = 14;
  const Model damaged = row_model(numbers(0, kBad)), good = row_model({});
  for (uint32_t calls = 0; calls < 300; calls += 7) {
    const Device device(kBad + 1, kFits);
    UnsteadyCard card{&damaged.bytes, Random(1), 0};
    for (uint32_t i = 0; i < calls; ++i) {
      device.load_with(along(0, kBad), UnsteadyCard::read, &card, 1);
    }
    card.bytes = &good.bytes;
    microtin_pack_clear_bad_tiles(device.pack);
    const microtin_status status = served(device, along(0, kBad), 1, card);
    uint32_t bad = 0;  // the one of which damaged bytes were in hand
    for (uint32_t tile = 0; tile <= kBad; ++tile) {
      if (why_bad(device, tile) == MICROTIN_STATUS_OK) {
        check_place(device, good, tile, true);
      } else {
        ++bad;
      }
    }
    CHECK(bad <= 1);
    CHECK(status == (bad == 0 ? MICROTIN_STATUS_OK : MICROTIN_STATUS_BAD_TILES));
  }
}

TEST_CASE_TEMPLATE("pack: nothing of one pack is left to the next, whatever was in hand", Device,
                   MeshSlots, CompactSlots) {
  const Model first = row_model({2, 3}, 24, 7), second = row_model({5}, 24, 0);
  for (const int32_t said : {-1, 0, 9999}) {
    for (int calls = 0; calls < 40; ++calls) {
      const Device device(2, kFits);
      CHECK(microtin_pack_align_reads(device.pack, 512) == MICROTIN_STATUS_OK);
      UnsteadyCard card{&first.bytes, Random(1), 0};
      for (int i = 0; i < calls; ++i) {
        device.load_with(along(1, 3), UnsteadyCard::read, &card, 2);
      }
      microtin_pack_complete_read(device.pack, said);
      microtin_pack_reset(device.pack);
      microtin_pack_info info;
      CHECK(microtin_pack_get_info(device.pack, &info) != MICROTIN_STATUS_OK);
      int32_t height = 0;
      CHECK(device.height_at(along(1, 1).x, 500, height) == MICROTIN_QUERY_NOT_LOADED);
      CHECK(why_bad(device, 2) == MICROTIN_STATUS_OK);
      card.bytes = &second.bytes;
      CHECK(served(device, along(2, 3), 2, card) == MICROTIN_STATUS_OK);
      CHECK(served(device, along(4, 5), 2, card) == MICROTIN_STATUS_BAD_TILES);
      check_place(device, second, 4, true);
    }
  }
}

TEST_CASE_TEMPLATE("pack: a segment that is too long causes no more reads", Device, MeshSlots,
                   CompactSlots) {
  Model model = row_model({4});
  UnsteadyCard card{&model.bytes, Random(1), 0};
  const Device device(2, kFits);
  CHECK(served(device, along(0, 3), 0, card) == MICROTIN_STATUS_WORKSPACE_TOO_SMALL);
  const uint32_t reads = card.reads;
  CHECK(served(device, along(0, 3), 0, card) == MICROTIN_STATUS_WORKSPACE_TOO_SMALL);
  CHECK(served(device, along(1, 2), 0, card) == MICROTIN_STATUS_OK);
  CHECK(card.reads > reads);
  // Another card with another tile there, of which nothing is known yet.
  microtin_pack_reset(device.pack);
  model = row_model({2});
  CHECK(served(device, along(0, 2), 0, card) == MICROTIN_STATUS_BAD_TILES);
}

TEST_CASE_TEMPLATE("pack: the result for a segment depends on the segment and on its tiles alone",
                   Device, MeshSlots, CompactSlots) {
  for (uint32_t seed = 0; seed < 400; ++seed) {
    CAPTURE(seed);
    run_sequence<Device>(seed);
  }
}

}  // namespace microtin::tests
