// SPDX-License-Identifier: MIT
// Filling voids.
#include "encoder/terrain/voids.hpp"

#include <doctest/doctest.h>

#include <cstdlib>

#include "tests/support/packs.hpp"

using namespace microtin::tests;

namespace {

constexpr int64_t kVoid = kVoidHeight;

// How many posts it fills.
uint64_t filled(Raster& raster, uint32_t largest) {
  const uint64_t before = raster.mended.filled;
  fill_voids(raster, largest);
  return raster.mended.filled - before;
}

}  // namespace

TEST_CASE("a single post gets the mean of its neighbours") {
  Raster raster = raster_of(3, {0, 10, 0, 20, kVoid, 40, 0, 30, 0});
  CHECK(filled(raster, 1) == 1);
  CHECK(raster.heights[4] == 25);
}

TEST_CASE("regions larger than allowed stay, corners do not connect") {
  Raster raster = raster_of(4, {1, kVoid, kVoid, 1,  //
                                kVoid, 1, 1, 1,      //
                                1, 1, 1, 1});
  CHECK(filled(raster, 0) == 0);
  CHECK(filled(raster, 1) == 1);
  CHECK(raster.heights[4] == 1);
  CHECK(raster.heights[1] == kVoid);
  CHECK(filled(raster, 2) == 2);
  CHECK(raster.heights[1] == 1);
}

TEST_CASE("nothing is made of nothing") {
  Raster raster = raster_of(2, {kVoid, kVoid, kVoid, kVoid});
  CHECK(filled(raster, 100) == 0);
  CHECK(raster.heights[0] == kVoid);
}

TEST_CASE("a plane goes on through a hole") {
  constexpr uint32_t kSide = 60;
  constexpr int64_t kBase = 1000000000000000;  // large numbers lose nothing
  std::vector<int64_t> heights;
  const auto plane = [](uint32_t x, uint32_t y) { return kBase + 1000 * x - 700 * y; };
  const auto in_hole = [](uint32_t x, uint32_t y) {
    return x > 5 && y > 5 && x < kSide - 3 && y < kSide - 8 && (x + y) % 23 != 0;
  };
  for (uint32_t y = 0; y < kSide; ++y) {
    for (uint32_t x = 0; x < kSide; ++x) heights.push_back(in_hole(x, y) ? kVoid : plane(x, y));
  }
  Raster raster = raster_of(kSide, heights);
  CHECK(filled(raster, kSide * kSide) > 2000);
  int64_t worst = 0;
  for (uint32_t y = 0; y < kSide; ++y) {
    for (uint32_t x = 0; x < kSide; ++x) {
      worst = std::max(worst, std::abs(raster.heights[size_t{y} * kSide + x] - plane(x, y)));
    }
  }
  CHECK(worst <= 1);
}

TEST_CASE("a region at the border continues its rim") {
  Raster raster = raster_of(4, {5, kVoid, kVoid, kVoid, 5, kVoid, kVoid, kVoid});
  CHECK(filled(raster, 6) == 6);
  for (const int64_t height : raster.heights) CHECK(height == 5);
}
