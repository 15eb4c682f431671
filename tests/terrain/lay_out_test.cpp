// SPDX-License-Identifier: MIT
// Sources as samples on the lattice.
#include "encoder/terrain/lay_out.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "encoder/base/error.hpp"
#include "tests/support/cloud_text.hpp"
#include "tests/support/packs.hpp"

using namespace microtin;
using namespace microtin::tests;

namespace {

Laid lay(const std::string& points, const LatticeOptions& options = {}) {
  return lay_out(cloud_of(points), options);
}

LatticeOptions options(const char* xy_step, const char* z_step, const char* max_error) {
  LatticeOptions all;
  if (*xy_step != 0) all.xy_step = parse_decimal(xy_step);
  if (*z_step != 0) all.z_step = parse_decimal(z_step);
  if (*max_error != 0) all.max_error = parse_decimal(max_error);
  return all;
}

std::string error_of(const std::string& points, const LatticeOptions& with) {
  try {
    lay(points, with);
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

TEST_CASE("samples are in lexicographic order, whatever the input's") {
  const Laid laid = lay("5 1 10\n2 9 20\n2 3 30\n");
  REQUIRE(laid.survey.samples.size() == 3);
  CHECK(laid.survey.samples[0].place == Point{2, 3});
  CHECK(laid.survey.samples[1].place == Point{2, 9});
  CHECK(laid.survey.samples[2].place == Point{5, 1});
  CHECK(laid.survey.samples[0].height == 30 * 65536);
  CHECK(laid.survey.samples[0].lowest == std::numeric_limits<int32_t>::min());
  CHECK(laid.survey.samples[0].highest == std::numeric_limits<int32_t>::max());
  CHECK(laid.merged == 0);
  CHECK(to_string(laid.xy_displacement) == "0");
  CHECK(to_string(laid.z_displacement) == "0");
}

TEST_CASE("the bound is rounded inwards, to 16 fractional bits of a step") {
  const Laid laid = lay("0 0 1\n9 0 2\n0 9 3", options("", "3", "2"));
  const Sample& s = laid.survey.samples[0];
  CHECK(s.height == 21845);   // 1/3 of a step
  CHECK(s.lowest == -21845);  // -1/3 is -21845.3
  CHECK(s.highest == 65536);  // (1 + 2) / 3
  CHECK(to_string(laid.z_step) == "3");
  CHECK(to_string(laid.z_displacement) == "1");
}

TEST_CASE("a bound beyond the lattice's heights is none") {
  const Laid laid = lay("0 0 32767\n9 0 -32768\n0 9 0", options("", "1", "40000.5"));
  CHECK(laid.survey.samples[0].lowest == -14467 * 32768);  // (32767 - 40000.5) * 65536
  CHECK(laid.survey.samples[0].highest == std::numeric_limits<int32_t>::max());
  CHECK(laid.survey.samples[2].lowest == std::numeric_limits<int32_t>::min());
}

TEST_CASE("points go to the nearest place, halves up, what shares one merges") {
  const Laid laid = lay("0 0 10\n9 1 20\n10 0 4\n11 0 8\n20 9 1", options("10", "1", ""));
  REQUIRE(laid.survey.samples.size() == 3);
  CHECK(laid.merged == 2);
  const Sample& merged = laid.survey.samples[1];
  CHECK(merged.place == Point{1, 0});
  CHECK(merged.height == 12 * 65536);  // the middle of 4 and 20, not the mean of all
  CHECK(laid.survey.samples[2].place == Point{2, 1});
  CHECK(to_string(laid.xy_displacement) == "1");
}

TEST_CASE("merged points leave what all of them allow") {
  const Laid laid = lay("0 0 10\n10 0 4\n11 0 8\n20 9 1", options("10", "1", "2"));
  CHECK(laid.survey.samples[1].lowest == 6 * 65536);
  CHECK(laid.survey.samples[1].highest == 6 * 65536);
}

TEST_CASE("limits at places without points are samples of their own, in order") {
  LatticeOptions narrow = options("1", "1", "2");
  narrow.tightenings = {{{0, 0}, -65536, 65536},         // of a point
                        {{3, 4}, 3 * 65536, 5 * 65536},  // of none
                        {{9, 9}, 70000, 60000}};         // of none, and they contradict each other
  const Laid laid = lay("0 0 0\n9 0 10\n0 9 20", narrow);
  REQUIRE(laid.survey.samples.size() == 5);
  CHECK(laid.merged == 0);
  CHECK(laid.survey.samples[0].highest == 65536);
  const Sample& added = laid.survey.samples[2];
  CHECK(added.place == Point{3, 4});
  CHECK(added.height == 4 * 65536);
  CHECK(added.lowest == 3 * 65536);
  CHECK(added.highest == 5 * 65536);
  const Sample& forced = laid.survey.samples[4];
  CHECK(forced.place == Point{9, 9});
  CHECK(forced.lowest == 65536);
  CHECK(forced.highest == 65536);
}

TEST_CASE("posts that a coarse lattice merges cause an error with a finer step") {
  try {
    LatticeOptions coarse = options("2", "", "1");
    lay_out(raster_of(4, {0, 0, 0, 0, 0, 50, 0, 0, 0, 0, 90, 0, 0, 0, 0, 0}), coarse);
    FAIL("is not refused");
  } catch (const Error& error) {
    CHECK_MESSAGE(
        std::string(error.what()).find("; use a smaller xy_step, or none") != std::string::npos,
        error.what());
  }
}

TEST_CASE("several heights at one position are refused with their number and the position") {
  const std::string remedy = "; use duplicates lowest, highest or mean";
  const std::string wall = "0.5 0 1\n100.25 7 4\n100.25 7 8.5\n200 9 0\n200 9 100\n";
  CHECK(error_of(wall, options("", "", "2.25")) ==
        "max_error cannot be kept at 1 positions where points of different heights meet, the first "
        "at "
        "x 200, y 9 with heights from 0 to 100" +
            remedy);
  CHECK(error_of(wall, options("", "", "2.2499")) ==
        "max_error cannot be kept at 2 positions where points of different heights meet, the first "
        "at "
        "x 100.25, y 7 with heights from 4 to 8.5" +
            remedy);
  CHECK(error_of(wall, options("", "", "")) == "none");
}

TEST_CASE("a step of height too coarse for the bound is refused with one that is not") {
  const std::string points = "0 0 1\n5 0 2\n0 5 3\n";
  CHECK(error_of(points, options("", "4", "0.9")) ==
        "max_error cannot be kept at 3 positions, where no whole z step is near enough; use z_step "
        "1.8 or less");
  CHECK(error_of(points, options("", "1.8", "0.9")) == "none");
  CHECK(error_of(points, options("", "4", "2")) == "none");
  CHECK(error_of(points, options("", "2", "0")) ==
        "max_error cannot be kept at 2 positions, where no whole z step is near enough; use z_step "
        "1 or less");
  CHECK(error_of(points, options("", "1", "0")) == "none");
  const std::string high = "0 0 0.01\n5 0 2.03\n0 5 3000.06\n";  // in steps of 0.05 at finest
  CHECK(error_of(high, options("", "", "0.01")) ==
        "max_error cannot be kept at 1 positions, where no whole z step is near enough; 16 bits "
        "hold these heights in steps of 0.05: use max_error 0.03 or more");
  CHECK(error_of(high, options("", "", "0.03")) == "none");
}

TEST_CASE("voids of rasters are kept, a lattice that merges them with heights is refused") {
  Raster raster;
  raster.width = 3;
  raster.height = 2;
  raster.heights = {1, kVoidHeight, 3, kVoidHeight, 5, kVoidHeight};
  const Laid whole = lay_out(raster, {});
  REQUIRE(whole.survey.voids.size() == 3);
  CHECK(whole.survey.voids[0] == Point{0, 1});
  CHECK(whole.survey.voids[1] == Point{1, 0});
  CHECK(whole.survey.voids[2] == Point{2, 1});
  CHECK(whole.survey.samples.size() == 3);
  CHECK_THROWS_WITH_AS(lay_out(raster, options("2", "", "")),
                       "xy_step is too coarse: 2 void posts share a position with a height, the "
                       "first at x 2, y 0; use a smaller one, or none",
                       Error);
}
