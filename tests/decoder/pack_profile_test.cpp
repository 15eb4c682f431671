// SPDX-License-Identifier: MIT
// Profiles through packs: against exact fractions, and against the profile of a mesh.
#include <doctest/doctest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "tests/support/pack_device.hpp"
#include "tests/support/pack_segments.hpp"
#include "tests/support/packs.hpp"
#include "tests/support/reference_profile.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/slow.hpp"

namespace microtin::tests {
namespace {

using namespace reference;

// A pack of which some tiles are there, and why others are not.
struct Loaded {
  TileGrid grid;
  std::vector<microtin_query_result> tiles;  // OK: it is there
  Surface surface;
};

std::vector<microtin_crossing> profile_of(const PackDevice& device, const microtin_segment& c) {
  std::vector<microtin_crossing> profile;
  microtin_segment_state state = {};
  microtin_crossing crossing = {0, 0, 0, 0};
  do {
    REQUIRE(device.profile_next(c, &state, &crossing) == MICROTIN_QUERY_OK);
    profile.push_back(crossing);
    REQUIRE(profile.size() < 1000);
  } while (crossing.along != MICROTIN_ALONG_END);
  microtin_crossing again = {0, 0, 0, 0};
  REQUIRE(device.profile_next(c, &state, &again) == MICROTIN_QUERY_OK);
  REQUIRE(same_crossing(again, crossing));
  return profile;
}

// How bad a reason is.
int badness(microtin_query_result answer) {
  return answer == MICROTIN_QUERY_NOT_LOADED ? 4
         : answer == MICROTIN_QUERY_BAD_TILE ? 3
         : answer == MICROTIN_QUERY_OUTSIDE  ? 2
         : answer == MICROTIN_QUERY_VOID     ? 1
                                             : 0;
}

// Where a segment meets the sides of a pack and of its tiles, strictly between two places, and
// these.
std::vector<Way> cuts_of(const TileGrid& grid, const microtin_segment& c, const Way& from,
                         const Way& to) {
  std::vector<Way> cuts = {from, to};
  const auto cut = [&](int64_t begin, int64_t end, uint32_t size, uint32_t most) {
    for (int64_t line = 0; line < int64_t{most} + size && begin != end; line += size) {
      const Wide part = Wide{std::min<int64_t>(line, most)} * 256 - begin, whole = end - begin;
      const Way way = whole < 0 ? Way{-part, -whole} : Way{part, whole};
      if (from < way && way < to) cuts.push_back(way);
    }
  };
  cut(c.x, c.x_end, grid.width, grid.x_max);
  cut(c.y, c.y_end, grid.height, grid.y_max);
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

// Why tiles do not know the place in the middle between two others.
microtin_query_result reason_between(const Loaded& pack, const microtin_segment& c, const Way& a,
                                     const Way& b) {
  const Wide part = a.part * b.whole + b.part * a.whole, whole = a.whole * b.whole * 2;
  const Wide x = c.x * whole + (c.x_end - c.x) * part, y = c.y * whole + (c.y_end - c.y) * part;
  microtin_query_result worst = MICROTIN_QUERY_OK;
  for (uint32_t tile = 0; tile < pack.tiles.size(); ++tile) {
    const TileBox box = tile_box(pack.grid, tile);
    const Wide unit = whole * 256;
    if (x < box.x * unit || x > box.x_end * unit || y < box.y * unit || y > box.y_end * unit)
      continue;
    const microtin_query_result here =
        pack.tiles[tile] == MICROTIN_QUERY_OK ? MICROTIN_QUERY_VOID : pack.tiles[tile];
    if (badness(here) > badness(worst)) worst = here;
  }
  return worst == MICROTIN_QUERY_OK ? MICROTIN_QUERY_OUTSIDE : worst;
}

microtin_query_result expected_before(const Loaded& pack, const microtin_segment& c,
                                      const std::vector<Stretch>& stretches, const Way& from,
                                      const Way& to) {
  const std::vector<Way> cuts = cuts_of(pack.grid, c, from, to);
  microtin_query_result worst = MICROTIN_QUERY_OK;
  for (size_t i = 1; i < cuts.size(); ++i) {
    if (!(cuts[i - 1] < cuts[i]) || is_known(stretches, cuts[i - 1], cuts[i])) continue;
    const microtin_query_result here = reason_between(pack, c, cuts[i - 1], cuts[i]);
    if (badness(here) > badness(worst)) worst = here;
  }
  return worst;
}

void check_profile(const PackDevice& device, const Loaded& pack, const microtin_segment& c) {
  CAPTURE(c.x);
  CAPTURE(c.y);
  CAPTURE(c.x_end);
  CAPTURE(c.y_end);
  const std::vector<microtin_crossing> profile = profile_of(device, c);
  REQUIRE(profile_fault(pack.surface, c, profile) == "");
  const std::vector<Meeting> places = expected_places(pack.surface, c);
  const std::vector<Stretch> stretches = stretches_of(pack.surface, c);
  for (size_t i = 1; i < places.size(); ++i) {
    CAPTURE(i);
    REQUIRE(profile[i].before ==
            expected_before(pack, c, stretches, places[i - 1].way, places[i].way));
  }
}

// Loads some tiles of a pack, after it has spoiled some others.
template <class Device>
Loaded load_some(const Device& device, Card& card, Random& random, uint32_t loaded_of_8) {
  const PackFile pack(card.bytes);
  Loaded loaded = {pack.grid(), {}, {}};
  REQUIRE(device.load(card, at(-1, -1)) == MICROTIN_STATUS_OK);  // the header
  for (uint32_t tile = 0; tile < pack.entries().size(); ++tile) {
    const TileBox box = tile_box(loaded.grid, tile);
    const int64_t x = (int64_t{box.x} + box.x_end) * 128, y = (int64_t{box.y} + box.y_end) * 128;
    microtin_query_result result = MICROTIN_QUERY_NOT_LOADED;
    if (random.below(8) < loaded_of_8) {
      const size_t at = static_cast<size_t>(pack.entries()[tile].offset);
      const bool is_bad = loaded_of_8 < 8 && pack.entries()[tile].size != 0 && random.below(8) == 0;
      if (is_bad) card.bytes[at] ^= 1;
      result = is_bad ? MICROTIN_QUERY_BAD_TILE : MICROTIN_QUERY_OK;
      REQUIRE(device.load(card, {x, y, x, y}) ==
              (is_bad ? MICROTIN_STATUS_BAD_TILES : MICROTIN_STATUS_OK));
      const std::optional<DecodedTerrain> terrain = pack.tile(tile);
      if (!is_bad && terrain) loaded.surface.add(terrain->mesh(), box.x, box.y);
    }
    loaded.tiles.push_back(result);
  }
  return loaded;
}

// Some segments begin or end outside.
microtin_segment segment_around(Random& random, const TileGrid& grid) {
  microtin_segment c = any_segment(random, grid);
  const auto shift = [&](int64_t& begin, int64_t& end) {
    const int64_t by = (static_cast<int64_t>(random.below(5)) - 2) * 256;
    begin += by;
    end += by;
  };
  if (random.below(2) == 0) shift(c.x, c.x_end);
  if (random.below(2) == 0) shift(c.y, c.y_end);
  return c;
}

}  // namespace

TEST_CASE_TEMPLATE(
    "pack: a profile has each place once, in order, and never claims what is not there", Device,
    MeshSlots, CompactSlots) {
  Random random(51);
  for (uint32_t round = 0; round < 160; ++round) {
    CAPTURE(round);
    Card card{random_pack(random)};
    const Device device(9);
    const Loaded pack = load_some(device, card, random, round % 3 == 0 ? 8 : 4);
    for (int i = 0; i < 60; ++i) {
      const microtin_segment c = segment_around(random, pack.grid);
      if (c.x != c.x_end || c.y != c.y_end) check_profile(device, pack, c);
    }
  }
}

TEST_CASE_TEMPLATE("pack: a profile on encoded tiles with voids is exact" * kSlow, Device,
                   MeshSlots, CompactSlots) {
  Random random(52);
  for (const VoidKind& kind : void_kinds()) {
    CAPTURE(kind.name);
    const Raster raster = rough_raster(61, 53, kind.at);
    Card card{write_pack(encode_pack(raster, pack_options(3, 100)))};
    const Device device(64);
    const Loaded pack = load_some(device, card, random, 6);
    for (int i = 0; i < tried(20); ++i) {
      const microtin_segment c = segment_around(random, pack.grid);
      if (c.x != c.x_end || c.y != c.y_end) check_profile(device, pack, c);
    }
  }
}

TEST_CASE_TEMPLATE("pack: the profile of one tile is that of its mesh", Device, MeshSlots,
                   CompactSlots) {
  Random random(53);
  for (int round = 0; round < 40; ++round) {
    const TileGrid grid = {6, 6, 6, 6};
    Card card{forged_pack(grid, {forged_tile(random_tile(random, 6, 6, round % 2 == 0, 20))})};
    const Device device(1);
    load_some(device, card, random, 8);
    const std::optional<DecodedTerrain> tile = PackFile(card.bytes).tile(0);
    for (int i = 0; i < 60; ++i) {
      const microtin_segment c = any_segment(random, grid);
      const bool is_place = c.x == c.x_end && c.y == c.y_end;
      const std::vector<microtin_crossing> profile = profile_of(device, c);
      microtin_segment_state state = {};
      for (const microtin_crossing& place : profile) {
        microtin_crossing expected;
        REQUIRE(microtin_mesh_profile_next(tile->mesh(), &c, &state, &expected, 0) ==
                MICROTIN_QUERY_OK);
        const auto in_pack = [](uint32_t result) {  // outside a tile's hull is void
          return result == MICROTIN_QUERY_OUTSIDE ? uint32_t{MICROTIN_QUERY_VOID} : result;
        };
        expected.result = in_pack(expected.result);
        expected.before = is_place ? uint32_t{MICROTIN_QUERY_OK} : in_pack(expected.before);
        REQUIRE(same_crossing(place, expected));
      }
    }
  }
}

TEST_CASE_TEMPLATE("pack: a profile whose state is of another segment ends", Device, MeshSlots,
                   CompactSlots) {
  Random random(54);
  Card card{random_pack(random)};
  const Device device(9);
  const Loaded pack = load_some(device, card, random, 8);
  for (int round = 0; round < 20000; ++round) {
    microtin_segment_state state;
    uint8_t bytes[sizeof state];
    for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random.below(round % 2 == 0 ? 4 : 256));
    std::memcpy(&state, bytes, sizeof state);
    microtin_crossing crossing = {0, 0, 0, 0};
    const microtin_segment c = segment_around(random, pack.grid);
    for (int i = 0; crossing.along != MICROTIN_ALONG_END; ++i) {
      REQUIRE(i < 1000);
      REQUIRE(device.profile_next(c, &state, &crossing) == MICROTIN_QUERY_OK);
    }
  }
}

}  // namespace microtin::tests
