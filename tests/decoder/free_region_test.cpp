// SPDX-License-Identifier: MIT
#include "shared/free_region.hpp"

#include <doctest/doctest.h>

#include "tests/support/point_sets.hpp"

namespace microtin::tests {
namespace {

// The triangle (v, c, a) with a certified triangle (a, w, v) behind its chord, and open other
// sides.
FreeRegion region_of(Point v, Point c, Point a, Point w) {
  FreeRegion region{};
  region.origin = v;
  region.corner[1] = c - v;
  region.corner[2] = a - v;
  region.side[kChord].certified = true;
  region.side[kChord].apex = w - v;
  free_area(region);
  return region;
}

// The box that encloses the region, within a square lattice up to `last`.
Box box_of(const FreeRegion& region, FastInt last) {
  const Offset first = Point{0, 0} - region.origin;
  Box box{first.x, first.y, first.x + last, first.y + last};
  enclose(region, box);
  return box;
}

bool holds(const Box& box, Offset p) {
  return p.x >= box.x0 && p.x <= box.x1 && p.y >= box.y0 && p.y <= box.y1;
}

}  // namespace

TEST_CASE("the box holds every legal place") {
  Random random(61);
  uint32_t legal = 0, lost = 0;
  for (const uint32_t side : {4u, 12u, 60u, 500u, 8000u, 65536u}) {
    const FastInt last = static_cast<FastInt>(side) - 1;
    for (int i = 0; i < 60000; ++i) {
      const Point v = point_in(random, side), c = point_in(random, side);
      const Point a = point_in(random, side), w = point_in(random, side);
      if (orient2d(v, c, a) <= 0 || orient2d(a, w, v) <= 0) continue;
      if (conflicts_with_triangle(a, w, v, c)) continue;
      const Box box = box_of(region_of(v, c, a, w), last);
      for (int j = 0; j < 8; ++j) {
        const Point p = point_in(random, side);
        if (!conflicts_with_triangle(v, c, a, p) || conflicts_with_triangle(a, w, v, p)) continue;
        ++legal;
        if (!holds(box, p - v)) ++lost;
      }
    }
  }
  CHECK(legal > 20000);
  CHECK(lost == 0);
}

// Circles of large radius, whose extremes are computed too far out: so far that they seem to lie
// inside the triangle. The places are legal, but one step beyond the box of the three corners.
TEST_CASE("the box holds legal places at the extremes of large circles") {
  const Point cases[][4] = {
      {{20450, 32528}, {17023, 32414}, {36453, 32788}, {37067, 32789}},
      {{29149, 32786}, {44312, 32557}, {42906, 32595}, {27708, 32787}},
      {{40134, 32924}, {42611, 32992}, {21565, 32666}, {19301, 32665}},
  };
  for (const auto& c : cases) {
    const Point place = c[3];
    REQUIRE(conflicts_with_triangle(c[0], c[1], c[2], place));
    FreeRegion region{};
    region.origin = c[0];
    region.corner[1] = c[1] - c[0];
    region.corner[2] = c[2] - c[0];
    region.side[kChord].certified = region.side[kChord].ghost = true;
    free_area(region);
    CHECK(holds(box_of(region, kLatticeMax), place - c[0]));
  }
}

}  // namespace microtin::tests
