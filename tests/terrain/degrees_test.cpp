// SPDX-License-Identifier: MIT
// Places in degrees that are none on Earth.
#include "encoder/terrain/degrees.hpp"

#include <doctest/doctest.h>

#include "encoder/base/error.hpp"
#include "tests/support/layers.hpp"

using namespace microtin::tests;

namespace {

Raster frame(Axis x, Axis y) {
  Raster raster;
  raster.width = 3;
  raster.height = 2;
  raster.x = x;
  raster.y = y;
  return raster;
}

}  // namespace

TEST_CASE("degrees: points, to the last decimal") {
  PointCloud cloud;
  cloud.xy_decimals = 1;
  cloud.points = {{-3600, 900, 0}, {3600, -900, 100}};
  CHECK_NOTHROW(expect_on_earth(cloud));
  const std::string remedy =
      ": x is the longitude and y the latitude; exchange them, or give the coordinate system that "
      "they are in";
  cloud.points.push_back({471, 1582, 0});
  CHECK_THROWS_WITH(
      expect_on_earth(cloud),
      ("point 3, at x 47.1, y 158.2: latitude 158.2 is beyond 90 degrees" + remedy).c_str());
  cloud.points[2] = {-3601, 0, 0};
  CHECK_THROWS_WITH(
      expect_on_earth(cloud),
      ("point 3, at x -360.1, y 0: longitude -360.1 is beyond 360 degrees" + remedy).c_str());
}

TEST_CASE("degrees: posts of rasters, the outer halves of cells may lie beyond the poles") {
  CHECK_NOTHROW(expect_on_earth(frame({358, 1, 1}, {89, 1, 1})));
  CHECK_NOTHROW(expect_on_earth(frame({-361, 1, 1}, {-90, 1, 1})));
  CHECK_NOTHROW(expect_on_earth(frame({359, 1, 1}, {89009, 1000, 1000})));  // rounded
  CHECK_THROWS_WITH(expect_on_earth(frame({0, 1, 1}, {179, 2, 2})),
                    doctest::Contains("row 2 from the south: latitude 90.5 is beyond 90 degrees"));
  CHECK_THROWS_WITH(expect_on_earth(frame({0, 1, 1}, {-91, 1, 1})),
                    doctest::Contains("row 1 from the south: latitude -91 is beyond 90 degrees"));
  CHECK_THROWS_WITH(expect_on_earth(frame({360, 1, 1}, {0, 1, 1})),
                    doctest::Contains("column 3 from the west: longitude 362 is beyond 360"));
}
