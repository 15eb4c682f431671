// SPDX-License-Identifier: MIT
// The length of a degree, compared with published ones.
#include <doctest/doctest.h>

#include "encoder/export/scene.hpp"
#include "tests/support/layers.hpp"

using namespace microtin::tests;

TEST_CASE("degree: as long as on WGS 84, to 0.2 m") {
  struct Length {
    double latitude, x, y;
  };
  for (const Length& published : {Length{0, 111319.5, 110574.3}, Length{45, 78846.8, 111131.8}}) {
    for (const double latitude : {published.latitude, -published.latitude}) {
      const Degree degree = degree_at(latitude);
      CHECK(std::abs(degree.x - published.x) < 0.2);
      CHECK(std::abs(degree.y - published.y) < 0.2);
    }
  }
}

TEST_CASE("degree: at a pole it still has a length in both directions") {
  for (const double latitude : {-1000.0, -90.0, 90.0, 1000.0}) {
    CHECK(degree_at(latitude).x == degree_at(89).x);
    CHECK(degree_at(latitude).y == degree_at(89).y);
  }
  CHECK(degree_at(89).x > 1900);
}
