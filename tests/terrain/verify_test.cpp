// SPDX-License-Identifier: MIT
// Measuring decoded terrains.
#include "encoder/terrain/verify.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/support/cloud_text.hpp"
#include "tests/support/streams.hpp"

using namespace microtin::tests;

namespace {

// A square of side 8 in the plane z = x, in lattice steps of 1/4 (x, y) and 1/10 (z).
DecodedTerrain tilted_square() {
  Tin tin;
  tin.vertices = {{0, 0, 0}, {8, 0, 8}, {0, 8, 0}, {8, 8, 8}};
  Metadata metadata;
  metadata.placement = {{0, 1, 4}, {0, 1, 4}, {0, 1, 10}};
  return DecodedTerrain(encode(tin, metadata));
}

Verification verify_points(const std::string& points, const char* bound) {
  return verify(tilted_square().mesh(), cloud_of(points), parse_decimal(bound));
}

}  // namespace

TEST_CASE("errors are exact, and rounded up only to print") {
  const Verification exact = verify_points("0 0 0\n2 2 0.8\n1 1.25 0.4\n", "0");
  CHECK(exact.posts == 3);
  CHECK(exact.covered == 3);
  CHECK(exact.within_bound);
  CHECK(to_string(exact.max_error) == "0");
  const Verification off = verify_points("0 0 0.25\n2 2 0.7\n", "0.25");
  CHECK(to_string(off.max_error) == "0.25");
  CHECK(off.within_bound);
  CHECK(to_string(off.rms_error) == "0.190394328");  // sqrt((0.25^2 + 0.1^2) / 2), rounded up
  CHECK(to_string(off.mean_error) == "-0.075");      // 0.25 too low, 0.1 too high
  CHECK(to_string(combine({off, exact}).mean_error) == "-0.03");
  CHECK_FALSE(verify_points("0 0 0.25\n", "0.249999999").within_bound);
}

TEST_CASE("errors of millions count in the mean as they are") {
  const Verification found = verify_points("0 0 3000000\n0 1 4000000\n0 2 0\n", "0");
  CHECK(to_string(found.mean_error) == "-2333333.333333333");
  const double rms = real(found.rms_error), expected = std::sqrt(25e12 / 3);
  CHECK(rms >= expected);
  CHECK(rms < expected + 0.04);
}

TEST_CASE("no bound is always kept") {
  const Verification found = verify(tilted_square().mesh(), cloud_of("0 0 1e15"), std::nullopt);
  CHECK(found.within_bound);
  CHECK(to_string(found.max_error) == "1000000000000000");
}

TEST_CASE("points off the terrain or the lattice are uncovered") {
  const Verification found = verify_points("0 0 0\n3 3 0\n-1 0 0\n1e9 0 0\n2.125 0 0", "1");
  CHECK(found.posts == 5);
  CHECK(found.covered == 1);
  CHECK(found.uncovered == 4);  // 2.125 is nearest to lattice 9
}

TEST_CASE("points that share a place count each") {
  const Verification found = verify_points("1 1 0.4\n1.01 1 0.5\n0.99 1 0.1\n", "0.3");
  CHECK(found.posts == 3);
  CHECK(to_string(found.max_error) == "0.3");
  CHECK(found.within_bound);
}

TEST_CASE("voids are counted where they answer") {
  Raster raster;
  raster.width = raster.height = 3;
  raster.x = raster.y = {0, 1, 1};
  raster.heights = {0, 0, 1, kVoidHeight, 0, kVoidHeight, 0, 0, 1};
  const Verification found = verify(tilted_square().mesh(), raster, std::nullopt);
  CHECK(found.posts == 7);
  CHECK(found.voids == 2);
  CHECK(found.voids_answered == 2);
}
