// SPDX-License-Identifier: MIT
// Which points are the posts of a raster.
#include <doctest/doctest.h>

#include "encoder/terrain/clouds.hpp"
#include "tests/support/cloud_text.hpp"
#include "tests/support/layers.hpp"

using namespace microtin::tests;

namespace {

// Rows of three posts, 0.5 apart in x and 2 in y, from the north-east.
const char* const kPosts =
    "11 7 9\n10.5 7 8\n10 7 7\n11 5 6\n10.5 5 5\n10 5 4\n11 3 3\n10.5 3 2\n10 3 1\n";

}  // namespace

TEST_CASE("gridded: points in any order are the raster that they lie on") {
  const std::optional<Raster> raster = gridded(cloud_of(kPosts));
  REQUIRE(raster.has_value());
  CHECK(raster->width == 3);
  CHECK(raster->height == 3);
  CHECK(raster->heights == std::vector<int64_t>{1, 2, 3, 4, 5, 6, 7, 8, 9});
  CHECK(raster->x.offset == 20);
  CHECK(raster->x.numerator == 1);
  CHECK(raster->x.denominator == 2);
  CHECK(raster->y.offset == 3);
  CHECK(raster->y.numerator == 2);
  CHECK(raster->y.denominator == 1);
  CHECK(warning_on_grid(cloud_of(kPosts)).find("3 x 3") != std::string::npos);
}

TEST_CASE("gridded: posts may be missing, up to half of them") {
  const std::optional<Raster> some = gridded(cloud_of("0 0 1\n2 0 2\n0 2 3\n2 2 4\n1 1 5\n"));
  REQUIRE(some.has_value());
  CHECK(some->heights ==
        std::vector<int64_t>{1, kVoidHeight, 2, kVoidHeight, 5, kVoidHeight, 3, kVoidHeight, 4});
  CHECK_FALSE(gridded(cloud_of("0 0 1\n2 0 2\n0 2 3\n1 1 5\n")).has_value());
}

TEST_CASE("gridded: others are not") {
  const std::string posts = kPosts;
  for (const char* const more : {"11 7 9\n", "11 7.001 9\n", "10.25001 3 1\n", "1000 3 1\n"}) {
    CAPTURE(more);
    CHECK_FALSE(gridded(cloud_of(posts + more)).has_value());
    CHECK(warning_on_grid(cloud_of(posts + more)).empty());
  }
  CHECK_FALSE(gridded(cloud_of("0 0 1\n1 0 2\n0 1 3\n1 1 4\n")).has_value());  // two rows
  CHECK_FALSE(gridded(cloud_of("0 0 1\n0 1 2\n0 2 3\n0 3 4\n")).has_value());  // one column
  CHECK_FALSE(gridded({}).has_value());
}
