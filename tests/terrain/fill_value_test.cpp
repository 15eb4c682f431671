// SPDX-License-Identifier: MIT
// Values that fill voids and are not said to.
#include <doctest/doctest.h>

#include <vector>

#include "encoder/terrain/voids.hpp"
#include "tests/support/layers.hpp"

using namespace microtin::tests;

namespace {

// "VALUE x COUNT", or "none".
std::string fill(const std::vector<int64_t>& heights, int decimals = 0) {
  Extremes all;
  for (const int64_t height : heights) all.add(height);
  const Extremes::Fill found = all.fill(decimals);
  if (found.count == 0) return "none";
  return std::to_string(found.value) + " x " + std::to_string(found.count);
}

}  // namespace

TEST_CASE("fill value: a usual number, farther from all others than they are from each other") {
  CHECK(fill({-9999, 100, 2500, -9999, 80}) == "-9999 x 2");
  CHECK(fill({65535, 100, 2500, 80}) == "65535 x 1");
  CHECK(fill({-32768, -40, 300}) == "-32768 x 1");
  CHECK(fill({-999900, 2512, 8000}, 2) == "-999900 x 1");
  CHECK(fill({-9999, 0, 0}) == "-9999 x 1");
}

TEST_CASE("fill value: heights that may be some are none") {
  CHECK(fill({}) == "none");
  CHECK(fill({-9999, -9999}) == "none");
  CHECK(fill({-9999, -5000, 8000}) == "none");   // the sea, to its ground
  CHECK(fill({-9998, 100, 2500}) == "none");     // not one that programs write
  CHECK(fill({-9999, 100, 2500}, 2) == "none");  // -99.99
  CHECK(fill({9999, 0, 4999, 5000}) == "none");
  CHECK(fill({9999, 0, 4999}) == "9999 x 1");
  CHECK(fill({999, 0, 1}) == "none");
}

TEST_CASE("fill value: parts of a terrain are joined in any order") {
  const std::vector<int64_t> heights = {5, -9999, 7, -9999, 3, 6, -9999};
  for (size_t cut = 0; cut <= heights.size(); ++cut) {
    Extremes first, second;
    for (size_t i = 0; i < heights.size(); ++i) (i < cut ? first : second).add(heights[i]);
    Extremes other = second;
    other.add(first);
    first.add(second);
    CHECK(first.fill(0).value == -9999);
    CHECK(first.fill(0).count == 3);
    CHECK(other.fill(0).count == 3);
  }
}
