#include "shared/free_region.hpp"

#include <doctest/doctest.h>

namespace microtin {

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
    const Box box = enclosing_box(region, Box{0, 0, kLatticeMax, kLatticeMax});
    CHECK(box.x0 <= place.x);
    CHECK(box.x1 >= place.x);
    CHECK(box.y0 <= place.y);
    CHECK(box.y1 >= place.y);
  }
}

}  // namespace microtin
