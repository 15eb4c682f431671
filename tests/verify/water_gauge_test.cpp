// SPDX-License-Identifier: MIT
// Posts of water that are not at the level.
#include <doctest/doctest.h>

#include "encoder/verify/verify.hpp"
#include "tests/support/packs.hpp"

namespace microtin::tests {

TEST_CASE("water: the gauge counts posts off the level") {
  const Raster raster = raster_of(2, {5, 5, 5, 9});
  WaterGauge gauge(raster.decimals, Decimal{5, 0});
  const PostVisitor visit = gauge.visitor();
  visit(0, 0, 5, 0);
  visit(1, 0, 5, 0.25);
  visit(1, 1, 9, 1);
  CHECK(gauge.moved() == 1);
  WaterGauge none(raster.decimals, std::nullopt);
  none.visitor()(0, 0, 5, 1);
  CHECK(none.moved() == 0);
}

}  // namespace microtin::tests
