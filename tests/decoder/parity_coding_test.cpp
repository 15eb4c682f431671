// SPDX-License-Identifier: MIT
#include "shared/parity_coding.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "tests/support/streams.hpp"

namespace microtin::tests {
namespace {

Tally tally_of(uint32_t even, uint32_t odd) {
  return Tally{{static_cast<uint16_t>(even), static_cast<uint16_t>(odd)}};
}

// Says a parity, and how likely it was.
struct Teller {
  bool odd = false;
  uint32_t asked = 0, probability = 0;

  bool bit(uint32_t of_odd, bool) {
    ++asked;
    probability = of_odd;
    return odd;
  }
};

std::vector<FastInt> lines_of(const Ruling& ruling) {
  std::vector<FastInt> lines;
  for (FastInt i = 0; i < ruling.numbers.count; ++i) {
    lines.push_back(line_at(ruling, ruling.numbers.first + i));
  }
  return lines;
}

std::vector<FastInt> lines_of_parity(Lines lines, bool odd_origin, bool odd) {
  std::vector<FastInt> kept;
  for (FastInt line = lines.first; line <= lines.last; ++line) {
    if ((((line + (odd_origin ? 1 : 0)) % 2 + 2) % 2 != 0) == odd) kept.push_back(line);
  }
  return kept;
}

// Places of the same terrain, this many steps apart, in a tile that begins somewhere in its pack.
size_t size_of(uint16_t step, uint16_t from_x, uint16_t from_y, Origin origin, Coding coding) {
  Tin tin = rolling_tin(1500, 41);
  for (Vertex& v : tin.vertices) {
    v.x = static_cast<uint16_t>(step * v.x + from_x);
    v.y = static_cast<uint16_t>(step * v.y + from_y);
  }
  return encode_and_decode(tin, Metadata(), {10, coding}, origin).stream.size();
}

}  // namespace

TEST_CASE("a ruling holds the lines of its parity, and no others") {
  for (FastInt first = -9; first <= 9; ++first) {
    for (FastInt last = first; last <= first + 40; ++last) {
      for (const bool odd_origin : {false, true}) {
        const Lines lines = {first, last};
        for (const bool odd : {false, true}) {
          Teller teller;
          teller.odd = odd;
          const Ruling ruling = rule(teller, tally_of(9, 1), lines, odd_origin, first);
          const std::vector<FastInt> expected = lines_of_parity(lines, odd_origin, odd);
          CHECK(teller.asked == (first < last ? 1 : 0));
          if (first < last) CHECK(lines_of(ruling) == expected);
          if (first == last) CHECK(lines_of(ruling) == std::vector<FastInt>{first});
          for (const FastInt line : lines_of(ruling)) {
            CHECK(line_at(ruling, number_of(ruling, line)) == line);
          }
        }
      }
    }
  }
}

TEST_CASE("where no parity is preferred none is coded") {
  for (const Tally tally : {tally_of(1, 1), tally_of(2, 1), tally_of(1, 2), tally_of(200, 100)}) {
    Teller teller;
    CHECK(lines_of(rule(teller, tally, Lines{-2, 2}, true, 0)).size() == 5);
    CHECK(teller.asked == 0);
  }
}

TEST_CASE("a parity is as likely as its lines are many and were met") {
  for (uint32_t even = 1; even < kTallyMost; even += 7) {
    for (uint32_t odd = 1; odd <= kTallyMost - even; odd += 5) {
      for (FastInt first = 0; first < 2; ++first) {
        for (FastInt last = first + 1; last < 70; ++last) {
          const auto count = static_cast<double>(last - first + 1);
          const auto odds = static_cast<double>(lines_of_parity({first, last}, false, true).size());
          const bool few = last - first + 1 < 32;
          const double of_odd = odd * (few ? odds : 1), of_even = even * (few ? count - odds : 1);
          const double exact = 32768 * of_odd / (of_odd + of_even);
          const uint32_t probability = probability_of_odd(tally_of(even, odd), {first, last});
          CHECK(probability >= 64);
          CHECK(probability <= 32704);
          CHECK(probability <= std::max(64.0, exact));
          CHECK(probability + 1 >= std::min(32704.0, exact));
        }
      }
    }
  }
}

TEST_CASE("a full tally is halved, and none falls to 0") {
  Tally tally = tally_of(1, 1);
  for (uint32_t i = 0; i < 5 * kTallyMost; ++i) {
    learn(tally, false);
    CHECK(tally.met[1] == 1);
    CHECK(tally.met[0] + 1u <= kTallyMost);
  }
  CHECK(tally.met[0] >= kTallyMost / 2);
  for (uint32_t i = 0; i < kTallyMost; ++i) learn(tally, true);
  CHECK(tally.met[1] > 2 * tally.met[0]);
}

// 2 bits for each of 1,500 vertices are 375 bytes, which is what its low bits cost if they are
// coded evenly; few vertices are on the hull.
TEST_CASE("a terrain on every other line takes hardly more bytes than one on all lines") {
  for (const Coding coding : {Coding::kQuick, Coding::kBalanced, Coding::kDense}) {
    const size_t every = size_of(1, 0, 0, {}, coding);
    CHECK(size_of(2, 0, 0, {}, coding) <= every + 40);
    CHECK(size_of(2, 1, 0, {true, false}, coding) <= every + 40);
    CHECK(size_of(2, 1, 1, {false, true}, coding) <= every + 40);
    CHECK(size_of(3, 0, 0, {}, coding) >= every + 200);
  }
}

}  // namespace microtin::tests
