// SPDX-License-Identifier: MIT
// Measuring decoded terrains.
#include "encoder/verify/verify.hpp"

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

namespace {

// A square of side 8 in one height.
DecodedTerrain flat_square(int64_t height = 0) {
  Tin tin;
  tin.vertices = {{0, 0, 0}, {8, 0, 0}, {0, 8, 0}, {8, 8, 0}};
  Metadata metadata;
  metadata.placement.z.offset = height;
  return DecodedTerrain(encode(tin, metadata));
}

PointCloud heights(const std::vector<int64_t>& z, int decimals) {
  PointCloud cloud;
  cloud.z_decimals = decimals;
  for (const int64_t height : z) {
    cloud.points.push_back({static_cast<int64_t>(cloud.points.size()), 0, height});
  }
  return cloud;
}

}  // namespace

TEST_CASE("errors of any size are rounded up, and none is cut off") {
  const DecodedTerrain square = flat_square();
  // More than a decimal's 63 bits hold of nine decimals.
  const Verification fine = verify(square.mesh(), heights({99999999999000001, 0}, 6), Decimal{});
  CHECK(to_string(fine.max_error) == "99999999999.000001");
  CHECK(to_string(fine.max_below) == "99999999999.000001");
  CHECK(to_string(fine.mean_error) == "-49999999999.5000005");
  const DecodedTerrain high = flat_square(10000000000);  // a billionth above what is cut
  const Verification cut =
      verify(high.mesh(), heights({1, 1}, 9), parse_decimal("9999999999.99999999"));
  CHECK(to_string(cut.max_error) == "10000000000");
  CHECK(to_string(cut.rms_error) == "10000000000");
  CHECK(to_string(cut.mean_error) == "10000000000");
  CHECK_FALSE(cut.within_bound);
  const Verification third =
      verify(square.mesh(), heights({99999999999000001, 0, 0}, 6), std::nullopt);
  CHECK(to_string(third.mean_error) == "-33333333333.00000033");  // to nearest

  const int64_t largest = 1000000000000000000;
  const Verification huge = verify(square.mesh(), heights({largest, -largest}, 0), std::nullopt);
  CHECK(to_string(huge.max_error) == std::to_string(largest));
  CHECK(to_string(huge.rms_error) == std::to_string(largest));
  CHECK(to_string(huge.mean_error) == "0");
  const Verification one = verify(square.mesh(), heights({largest, 0, 0, 0}, 0), std::nullopt);
  CHECK(to_string(one.rms_error) == std::to_string(largest / 2));
  CHECK(to_string(one.mean_error) == std::to_string(-largest / 4));
  const Verification all = combine(std::vector<Verification>(1000, one));
  CHECK(to_string(all.mean_error) == std::to_string(-largest / 4));
  CHECK(to_string(all.rms_error) == std::to_string(largest / 2));
}

TEST_CASE("the root of a mean square is exact where squares are many and large") {
  const DecodedTerrain square = flat_square();
  const Verification found =
      verify(square.mesh(), heights({3000000000000001, 4000000000000007}, 3), std::nullopt);
  CHECK(to_string(found.rms_error) == "3535533905932.742007");  // of ...2006066...
}

namespace {

Verification part_of(uint64_t covered, const char* rms_error) {
  Verification part;
  part.covered = covered;
  part.rms_error = *parse_decimal(rms_error);
  return part;
}

std::string combined_rms(const std::vector<Verification>& parts) {
  return to_string(combine(parts).rms_error);
}

}  // namespace

TEST_CASE("errors of parts together are rounded up once, as those of each") {
  for (const char* const rms : {"0.1", "0.3", "3.3", "0.000000001", "123456.789012345", "1e12"}) {
    const std::string same = to_string(*parse_decimal(rms));
    CHECK(combined_rms({part_of(1, rms), part_of(2, rms)}) == same);
    CHECK(combined_rms(std::vector<Verification>(7, part_of(1000003, rms))) == same);
  }
  CHECK(combined_rms({part_of(1, "3"), part_of(1, "4")}) == "3.535533906");    // of ...905...
  CHECK(combined_rms({part_of(2, "0.5"), part_of(1, "0")}) == "0.408248291");  // of ...0463
  CHECK(combined_rms({part_of(1, "30000000.000000007"), part_of(2, "30000000.000000009")}) ==
        "30000000.000000009");  // of ...0083
  CHECK(combined_rms({part_of(9, "0"), part_of(7, "0")}) == "0");
}

TEST_CASE("errors of more parts than are added up exactly are not below their root") {
  constexpr uint64_t kMany = uint64_t{1} << 32;
  const std::vector<Verification> usual(1 << 20, part_of(kMany, "68.7"));
  CHECK(combined_rms(usual) == "68.7");
  const std::vector<Verification> huge(1 << 20, part_of(kMany, "999999999999999999"));
  const double rms = real(combine(huge).rms_error);
  CHECK(rms >= 999999999999999999.0);
  CHECK(rms <= 1000000000100000000.0);
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

TEST_CASE("voids with heights are counted") {
  Raster raster;
  raster.width = raster.height = 3;
  raster.x = raster.y = {0, 1, 1};
  raster.heights = {0, 0, 1, kVoidHeight, 0, kVoidHeight, 0, 0, 1};
  const Verification found = verify(tilted_square().mesh(), raster, std::nullopt);
  CHECK(found.posts == 7);
  CHECK(found.voids == 2);
  CHECK(found.voids_answered == 2);
}
