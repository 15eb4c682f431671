// SPDX-License-Identifier: MIT
// Water before a terrain is encoded.
#include <doctest/doctest.h>

#include "encoder/base/error.hpp"
#include "encoder/terrain/lay_out.hpp"
#include "encoder/terrain/voids.hpp"
#include "tests/support/packs.hpp"

namespace microtin::tests {
namespace {

constexpr int64_t kNoData = kVoidHeight;

LatticeOptions options_of(std::optional<Decimal> z_step, bool never_below) {
  return {std::nullopt, z_step, Decimal{7, 0}, never_below, Decimal{5, 0}};
}

}  // namespace

TEST_CASE("water: voids are flooded, heights never change") {
  Raster raster = raster_of(3, {1, kNoData, 7, kNoData, 0, kNoData});
  flood_voids(raster, {4, 0}, nullptr);
  CHECK(raster.mended.flooded == 3);
  CHECK(raster.heights == std::vector<int64_t>{1, 4, 7, 4, 0, 4});
}

TEST_CASE("water: a mask selects voids") {
  Raster raster = raster_of(3, {1, kNoData, 7, kNoData, 0, kNoData});
  const Raster mask = raster_of(3, {1, 1, 1, 0, 1, kNoData});
  CHECK_NOTHROW(check_water_mask(mask, raster));
  flood_voids(raster, {4, 0}, &mask);
  CHECK(raster.mended.flooded == 1);
  CHECK(raster.heights == std::vector<int64_t>{1, 4, 7, kNoData, 0, kNoData});
}

TEST_CASE("water: a level with more decimals than the heights refines these") {
  Raster raster = raster_of(2, {1, kNoData, -7, kNoData});
  flood_voids(raster, {25, 2}, nullptr);
  CHECK(raster.mended.flooded == 2);
  CHECK(raster.decimals == 2);
  CHECK(raster.heights == std::vector<int64_t>{100, 25, -700, 25});
  Raster high = raster_of(2, {1000000000000000000, 1, 1, kNoData});
  CHECK_THROWS_WITH_AS(flood_voids(high, {5, 1}, nullptr),
                       "the water level has too many decimals for these heights; round it", Error);
}

TEST_CASE("water: masks of other posts or with other numbers are refused") {
  const Raster raster = raster_of(2, {1, kNoData, 7, kNoData});
  CHECK_THROWS_WITH_AS(
      check_water_mask(raster_of(4, {1, 0, 1, 0}), raster),
      "its grid differs from the terrain's; it must have the same columns, rows and cells", Error);
  Raster elsewhere = raster_of(2, {1, 0, 1, 0});
  elsewhere.x.offset = 1;
  CHECK_THROWS_WITH_AS(
      check_water_mask(elsewhere, raster),
      "its grid differs from the terrain's; it must have the same columns, rows and cells", Error);
  CHECK_THROWS_WITH_AS(check_water_mask(raster_of(2, {1, 0, 2, 0}), raster),
                       "a water mask contains only 0 and 1", Error);
}

TEST_CASE("water: a z step too coarse to keep land dry is refused, with the largest that is not") {
  const Raster raster = raster_of(3, {5, 5, 5, 5, 6, 5, 5, 5, 5});
  CHECK_NOTHROW(lay_out(raster, options_of(Decimal{8, 0}, false)));
  CHECK_THROWS_WITH_AS(lay_out(raster, options_of(Decimal{9, 0}, false)),
                       "max_error cannot be kept at 1 positions, where no whole z step is near "
                       "enough; use z_step 8 or less",
                       Error);
}

}  // namespace microtin::tests
