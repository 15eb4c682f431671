// SPDX-License-Identifier: MIT
#include "shared/place_coding.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "tests/support/point_sets.hpp"

namespace microtin::tests {
namespace {

// Keeps what is coded, and how many bits it takes at most.
struct Recorder {
  Vertex known;
  std::vector<uint32_t> symbols;
  bool escaped = false;

  Vertex next() const { return known; }
  bool bit(uint32_t probability, bool value) {
    CHECK(probability >= static_cast<uint32_t>(kProbabilityMargin));
    CHECK(probability <= kProbabilityOne - static_cast<uint32_t>(kProbabilityMargin));
    symbols.push_back(value ? 1 : 0);
    return value;
  }
  uint32_t uniform(uint32_t count, uint32_t value) {
    CHECK(count <= 65536);
    CHECK(value < count);
    symbols.push_back(value);
    return value;
  }
  uint32_t uniform_or_escape(uint32_t count, uint32_t value) {
    CHECK(count <= 16384);
    escaped |= value >= count;
    symbols.push_back(std::min(value, count));
    return symbols.back();
  }
};

// Reads them again.
struct Player {
  const std::vector<uint32_t>& symbols;
  size_t at = 0;

  static Vertex next() { return Vertex{0, 0, 0}; }
  bool bit(uint32_t, bool) { return symbols[at++] != 0; }
  uint32_t uniform(uint32_t, uint32_t) { return symbols[at++]; }
  uint32_t uniform_or_escape(uint32_t, uint32_t) { return symbols[at++]; }
};

struct Case {
  Point v, c, a;  // counter-clockwise
  Side chord, next;
  bool opposite_certified;
  Log2 density;
  PlaceHabits habits;
};

FreeRegion region_of(const Case& given) {
  FreeRegion region{};
  see_corners(region, given.v, given.c, given.a);
  region.chord = given.chord;
  region.next = given.next;
  region.opposite_certified = given.opposite_certified;
  region.expected = free_area(region) + given.density;
  return region;
}

PlaceModel model() {
  PlaceModel model;
  auto* const bits = reinterpret_cast<AdaptiveBit*>(&model);
  for (size_t i = 0; i < sizeof model / sizeof(AdaptiveBit); ++i) bits[i] = adaptive_bit(128);
  return model;
}

template <class Coder>
Offset code(Coder& coder, const Case& given, const Contract& contract) {
  const FreeRegion region = region_of(given);
  PlaceModel bits = model();
  Place place;
  PlaceHabits habits = given.habits;
  return code_place(coder, bits, region, contract, given.density, place, habits);
}

// Whether a place comes back in each setting of decoding.
bool comes_back(const Case& given, Contract contract, Point place) {
  for (const Coding coding : {Coding::kQuick, Coding::kBalanced, Coding::kDense}) {
    contract.coding = coding;
    Recorder recorder{Vertex{place.x, place.y, 0}, {}};
    code(recorder, given, contract);
    Player player{recorder.symbols};
    const Offset at = code(player, given, contract);
    const Offset expected = place - given.v;
    if (at.x != expected.x || at.y != expected.y || player.at != recorder.symbols.size()) {
      return false;
    }
  }
  return true;
}

Contract square_lattice(uint32_t side) {
  Contract contract{};
  contract.x_max = contract.y_max = static_cast<uint16_t>(side - 1);
  contract.has_heights = true;
  return contract;
}

// A random side with an apex anywhere behind it.
Side random_side(Random& random, uint32_t size, Point from, Point to, bool certified) {
  Side side{};
  side.certified = certified;
  side.ghost = random.below(8) == 0;
  side.apex = point_in(random, size);
  side.ghost = side.ghost || orient2d(to, from, side.apex) <= 0;
  return side;
}

Tally random_tally(Random& random) {
  const auto even = static_cast<uint16_t>(1 + random.below(kTallyMost - 1));
  return Tally{{even, static_cast<uint16_t>(1 + random.below(kTallyMost - even))}};
}

Case random_case(Random& random, uint32_t size) {
  Case given{};
  do {
    given.v = point_in(random, size);
    given.c = point_in(random, size);
    given.a = point_in(random, size);
  } while (orient2d(given.v, given.c, given.a) <= 0);
  given.next = random_side(random, size, given.v, given.c, random.below(2) == 0);
  given.opposite_certified = random.below(2) == 0;
  given.chord = random_side(random, size, given.a, given.v, true);
  given.density = static_cast<Log2>(random.below(32768)) - 16384;
  given.habits.crowding = kCrowdingLeast + static_cast<Crowding>(random.below(kCrowdingMost));
  for (Tally& tally : given.habits.parities.first) tally = random_tally(random);
  for (auto& tallies : given.habits.parities.second) {
    for (Tally& tally : tallies) tally = random_tally(random);
  }
  return given;
}

// Nearly on a line, as long as the lattice.
Case needle(Random& random, uint32_t size) {
  Case given = random_case(random, size);
  const auto last = static_cast<uint16_t>(size - 1);
  const auto step = static_cast<uint16_t>(random.below(3));
  given.v = Point{0, 0};
  given.a = Point{last, static_cast<uint16_t>(last - step)};
  const auto middle = static_cast<uint16_t>(random.below(last));
  given.c = Point{middle, static_cast<uint16_t>(middle + 1)};
  if (orient2d(given.v, given.c, given.a) <= 0) std::swap(given.c, given.a);
  for (Side* const side : {&given.chord, &given.next}) {
    if (side->apex == given.v) side->ghost = true;
  }
  return given;
}

}  // namespace

TEST_CASE("every place of a lattice comes back, whatever is estimated of it") {
  Random random(61);
  uint32_t lost = 0;
  for (const uint32_t size : {4u, 12u, 60u, 500u, 8000u, 65536u}) {
    Contract contract = square_lattice(size);
    for (int i = 0; i < 3000; ++i) {
      contract.odd_origin_x = random.below(2) != 0;
      contract.odd_origin_y = random.below(2) != 0;
      const Case given = i % 8 == 0 ? needle(random, size) : random_case(random, size);
      if (orient2d(given.v, given.c, given.a) <= 0) continue;
      for (int j = 0; j < 3; ++j) {
        if (!comes_back(given, contract, point_in(random, size))) ++lost;
      }
    }
  }
  CHECK(lost == 0);
}

TEST_CASE("any symbols decode to a position of the lattice") {
  struct Babbler {
    Random& random;

    static Vertex next() { return Vertex{0, 0, 0}; }
    bool bit(uint32_t, bool) { return random.below(4) == 0; }
    uint32_t uniform(uint32_t count, uint32_t) { return random.below(count); }
    uint32_t uniform_or_escape(uint32_t count, uint32_t) { return random.below(count + 1); }
  };
  Random random(63);
  Babbler babbler{random};
  for (const uint32_t size : {4u, 12u, 60u, 500u, 65536u}) {
    for (int i = 0; i < 20000; ++i) {
      Contract contract = square_lattice(size);
      const Case given = i % 8 == 0 ? needle(random, size) : random_case(random, size);
      if (orient2d(given.v, given.c, given.a) <= 0) continue;
      contract.coding = static_cast<Coding>(1 + random.below(3));
      const Offset at = code(babbler, given, contract);
      const FastInt x = given.v.x + at.x, y = given.v.y + at.y;
      CHECK((x >= 0 && x <= contract.x_max && y >= 0 && y <= contract.y_max));
    }
  }
}

// The escape takes 42 bits: it must be rare where a triangle is no sliver.
TEST_CASE("the estimate misses few legal positions") {
  Random random(62);
  uint32_t legal = 0, missed = 0;
  for (const uint32_t size : {12u, 60u, 500u, 8000u, 65536u}) {
    const Contract contract = square_lattice(size);
    for (int i = 0; i < 20000; ++i) {
      Case given{};
      given.v = point_in(random, size);
      given.c = point_in(random, size);
      given.a = point_in(random, size);
      const Point behind = point_in(random, size), place = point_in(random, size);
      if (orient2d(given.v, given.c, given.a) <= 0) continue;
      if (orient2d(given.a, behind, given.v) <= 0) continue;
      if (conflicts_with_triangle(given.a, behind, given.v, given.c)) continue;
      if (!conflicts_with_triangle(given.v, given.c, given.a, place)) continue;
      if (conflicts_with_triangle(given.a, behind, given.v, place)) continue;
      given.chord.certified = true;
      given.chord.apex = behind;
      const FreeRegion region = region_of(given);
      if (cotangent(region.cc - region.ca, region.by_twice, kOwnCap) >= 16 << kCotangentBits)
        continue;
      ++legal;
      Place at;
      PlaceModel bits = model();
      PlaceHabits habits;
      reset(habits);
      Contract quick = contract;
      quick.coding = Coding::kQuick;
      Recorder recorder{Vertex{place.x, place.y, 0}, {}};
      code_place(recorder, bits, region, quick, 0, at, habits);
      missed += recorder.escaped;
    }
  }
  CAPTURE(missed);
  CHECK(legal > 1000);
  CHECK(missed * 200 <= legal);
}

// format-stream.md's cotangent of the circle behind a side from v to `end`.
int64_t behind_of(const FreeRegion& region, Point apex, Spot end, int64_t turn) {
  const auto scaled = [](int64_t v, int64_t shift) {
    return shift < 0 ? v >> -shift : v * (int64_t{1} << shift);
  };
  const auto bit = [](int64_t v) { return int64_t{highest_bit(static_cast<uint32_t>(v))}; };
  const int64_t x = int64_t{apex.x} - region.origin.x, y = int64_t{apex.y} - region.origin.y;
  const int64_t m = std::max<int64_t>(0, bit(std::abs(x) | std::abs(y)) + region.shift - 10);
  const int64_t dx = scaled(x, region.shift - m), dy = scaled(y, region.shift - m);
  const int64_t ex = end.x >> m, ey = end.y >> m;
  const int64_t q = dx * (ex - dx) + dy * (ey - dy);
  const int64_t h = std::max<int64_t>(1, turn * (ex * dy - ey * dx));
  const int64_t s = std::max<int64_t>(0, bit(h) - 11), most = 16 * (h >> s);
  return std::clamp(q >> s, -most, most) * 4096 / (h >> s);
}

TEST_CASE("regions are measured as format-stream.md says") {
  Random random(64);
  size_t wrong = 0, behind = 0;
  for (int i = 0; i < 200000; ++i) {
    const uint32_t size = uint32_t{4} << random.below(15);
    const Case given = random_case(random, size);
    const FreeRegion region = region_of(given);
    const int64_t scale = region.shift;
    const auto scaled = [scale](int v) { return scale < 0 ? v >> -scale : v * (1 << scale); };
    const Spot c = {scaled(given.c.x - given.v.x), scaled(given.c.y - given.v.y)};
    const Spot a = {scaled(given.a.x - given.v.x), scaled(given.a.y - given.v.y)};
    const int longest =
        std::max({std::abs(given.c.x - given.v.x), std::abs(given.c.y - given.v.y),
                  std::abs(given.a.x - given.v.x), std::abs(given.a.y - given.v.y)});
    wrong += longest >> (10 - scale) != 1;
    wrong += region.c.x != c.x || region.c.y != c.y || region.a.x != a.x || region.a.y != a.y;
    wrong += region.cc != dot(c, c) || region.aa != dot(a, a) || region.ca != dot(c, a);
    wrong += region.by_twice.h != divisor_of(std::max(1, cross(c, a))).h;
    if (!region.chord.ghost) {
      wrong += region.chord.behind != behind_of(region, region.chord.apex, a, 1);
      ++behind;
    }
    if (region.next.certified && !region.next.ghost) {
      wrong += region.next.behind != behind_of(region, region.next.apex, c, -1);
      ++behind;
    }
  }
  CHECK(wrong == 0);
  CHECK(behind > 50000);
}

#if defined(MICROTIN_PAIRS)

TEST_CASE("distances of two places at once are those of each") {
  Random random(63);
  const auto within = [&random](int32_t most) {
    const uint32_t kind = random.below(8);
    if (kind < 2) return kind == 0 ? most : -most;
    return static_cast<int32_t>(random.below(2 * static_cast<uint32_t>(most) + 1)) - most;
  };
  size_t wrong = 0, counted = 0;
  for (int i = 0; i < 2000000; ++i) {
    LegalPlaces places{};
    places.corner[0] = Spot{within(2047), within(2047)};
    places.corner[1] = Spot{within(2047), within(2047)};
    const Reach reach =
        reach_of(2 * kLog2One + static_cast<Log2>(random.below(26 * 256 + 1)), places);
    const int32_t most = 1 << random.below(15);  // near the corners, too
    const int32_t x = within(most < 1 << 14 ? most : 23170);
    const int32_t low = within(i % 3 == 0 ? 35900 : most), high = within(i % 5 == 0 ? 35900 : most);
    const ColumnDistances at = distances_at(reach, places, x, low, high);
    const int32_t first = distance_at(reach, places, x, low);
    wrong += at.low != first || at.high != distance_at(reach, places, x, high);
    counted += first > 0 && first < 254;
  }
  CHECK(wrong == 0);
  CHECK(counted > 100000);
}

#endif

TEST_CASE("quarters turn a place, and both corners at once, by definition") {
  Random random(64);
  const auto coordinate = [&random] { return static_cast<int32_t>(random.below(4095)) - 2047; };
  size_t wrong = 0;
  for (int i = 0; i < 100000; ++i) {
    FreeRegion region{};
    region.c = Spot{coordinate(), i % 7 == 0 ? -2047 : coordinate()};
    region.a = Spot{i % 5 == 0 ? 2047 : coordinate(), coordinate()};
    Spot expected[2] = {region.c, region.a};
    for (int32_t turns = 0; turns < 4; ++turns) {
      const Spot place = turned(region.c, turns);
      wrong += place.x != expected[0].x || place.y != expected[0].y;
      Spot corner[2];
      turn_corners(region, turns, corner);
      for (int k = 0; k < 2; ++k) {
        wrong += corner[k].x != expected[k].x || corner[k].y != expected[k].y;
        expected[k] = Spot{-expected[k].y, expected[k].x};
      }
    }
  }
  CHECK(wrong == 0);
}

TEST_CASE("what is not known covers nothing") {
  for (const int32_t x : {-23170, -1, 0, 1, 23170}) CHECK(square_at(kNoCircle, x) < 0);
}

TEST_CASE("places are turned back to where they were") {
  for (const Spot a : {Spot{-9, 4}, Spot{9, 4}, Spot{3, 9}, Spot{3, -9}, Spot{-5, -5}, Spot{5, 5},
                       Spot{5, -5}, Spot{-5, 5}}) {
    const int32_t turns = turns_for(a);
    const Spot west = turned(a, turns), back = turned(west, -turns & 3);
    CHECK(west.x < 0);
    CHECK(absolute(west.y) <= -west.x);
    CHECK(back.x == a.x);
    CHECK(back.y == a.y);
  }
}

}  // namespace microtin::tests
