// SPDX-License-Identifier: MIT
// The terrain that the program makes itself: the same everywhere.
#include "encoder/terrain/fractal.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <sstream>

#include "encoder/base/error.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/slow.hpp"

using namespace microtin::tests;

namespace {

// FNV-1a over the heights.
uint64_t checksum(const std::vector<int16_t>& heights) {
  uint64_t sum = 0xCBF29CE484222325u;
  for (const int16_t z : heights) sum = (sum ^ static_cast<uint16_t>(z)) * 0x100000001B3u;
  return sum;
}

}  // namespace

TEST_CASE("fractal: a seed gives the same heights on every machine") {
  CHECK(checksum(fractal_heights(65, 1)) == 2841504457776971436u);
  CHECK(checksum(fractal_heights(65, 2)) == 788200009766002349u);
}

TEST_CASE("fractal: heights are those of mountains in a sea" * kSlow) {
  const std::vector<int16_t> heights = fractal_heights(257, 1);
  REQUIRE(heights.size() == 257 * 257);
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  CHECK(*low == 0);
  CHECK(*high > 1000);
  CHECK(*high < 2600);
}

TEST_CASE("fractal: a grid is written from north to south") {
  const std::vector<int16_t> heights = fractal_heights(3, 7);
  std::ostringstream out;
  write_fractal_asc(out, 3, 7);
  std::ostringstream expected;
  expected << "ncols 3\nnrows 3\nxllcenter 0\nyllcenter 0\ncellsize 30\n"
           << heights[6] << ' ' << heights[7] << ' ' << heights[8] << '\n'
           << heights[3] << ' ' << heights[4] << ' ' << heights[5] << '\n'
           << heights[0] << ' ' << heights[1] << ' ' << heights[2] << '\n';
  CHECK(out.str() == expected.str());
}

TEST_CASE("fractal: sizes out of range are refused") {
  CHECK_THROWS_AS(fractal_heights(1, 1), Error);
  CHECK_THROWS_AS(fractal_heights(8194, 1), Error);
}
