// SPDX-License-Identifier: MIT
// Sources within a bound, all the way: the step chosen, encoded, decoded and measured.
#include <doctest/doctest.h>

#include <cmath>

#include "encoder/base/error.hpp"
#include "encoder/fit/simplify.hpp"
#include "encoder/import/import.hpp"
#include "encoder/terrain/fractal.hpp"
#include "tests/support/approximations.hpp"
#include "tests/support/point_sets.hpp"

using namespace microtin;
using namespace microtin::tests;

namespace {

Raster mountains(uint32_t size) {
  Raster raster;
  raster.width = raster.height = size;
  for (const int16_t z : fractal_heights(size, 4)) raster.heights.push_back(z);
  return raster;
}

// Heights in thousandths, most of them no whole number.
Raster dunes(uint32_t size) {
  Raster raster;
  raster.width = raster.height = size;
  raster.decimals = 3;
  for (uint32_t i = 0; i < size * size; ++i) {
    const uint32_t row = i / size;
    const double x = i % size, y = row;
    const double height = 900 * std::sin(x / 9) + 700 * std::cos(y / 7 + x / 20);
    raster.heights.push_back(std::lround(height));
  }
  return raster;
}

void cut_voids(Raster& raster) {
  for (uint32_t i = 0; i < raster.heights.size(); ++i) {
    const uint32_t x = i % raster.width, y = i / raster.width;
    if ((x > 20 && x < 30 && y > 5 && y < 33) || x * y % 61 == 7) raster.heights[i] = kVoidHeight;
  }
}

LatticeOptions within(const char* bound) {
  LatticeOptions options;
  options.max_error = parse_decimal(bound);
  return options;
}

struct Found {
  size_t bytes;
  Decimal z_step;
  Verification measured;
};

Found find(const Source& source, const LatticeOptions& lattice, Search search = Search::kFast) {
  const auto [found, encoding, measured] = approximated(source, lattice, search);
  CHECK(measured.within_bound);
  CHECK(measured.uncovered == 0);
  CHECK(measured.voids_answered == 0);
  return {encoding.stream.size(), found.laid.z_step, measured};
}

}  // namespace

TEST_CASE("approximation: bounds hold, for whole and fractional heights, with and without voids") {
  for (Raster raster : {mountains(49), dunes(49)}) {
    const bool whole = raster.decimals == 0;
    for (const char* bound :
         {whole ? "20" : "0.2", whole ? "3.5" : "0.0371", whole ? "1" : "0.01"}) {
      CAPTURE(bound);
      find(raster, within(bound));
    }
    cut_voids(raster);
    CHECK(find(raster, within(whole ? "7" : "0.1"), Search::kNormal).measured.voids > 200);
  }
}

TEST_CASE("approximation: nothing is lost if nothing may be") {
  const Raster raster = dunes(20);
  CHECK(to_string(find(raster, within("0")).measured.max_error) == "0");
  CHECK(to_string(find(mountains(20), within("0")).measured.max_error) == "0");
}

TEST_CASE("approximation: the step is the best one, or the one that an option sets") {
  const Raster raster = mountains(97);
  const Found chosen = find(raster, within("10"), Search::kNormal);
  CHECK(Decimal{4, 0} <= chosen.z_step);
  CHECK(chosen.z_step <= Decimal{8, 0});
  for (const char* step : {"1", "4", "8"}) {
    LatticeOptions lattice = within("10");
    lattice.z_step = parse_decimal(step);
    const Found asked = find(raster, lattice, Search::kNormal);
    CHECK(asked.z_step == *lattice.z_step);
    CHECK(chosen.bytes < asked.bytes * 103 / 100);
  }
  LatticeOptions coarse = within("1.5");
  coarse.z_step = parse_decimal("4");
  CHECK_THROWS_AS(approximate(raster, coarse, {true, 0, Search::kFast, false, true, 1, {}, {}}),
                  Error);
}

TEST_CASE("approximation: a longer search takes fewer bytes") {
  const Raster raster = mountains(65);
  const size_t fast = find(raster, within("10"), Search::kFast).bytes;
  const size_t normal = find(raster, within("10"), Search::kNormal).bytes;
  CHECK(normal < fast);
  CHECK(find(raster, within("10"), Search::kBest).bytes <= normal);
}

TEST_CASE("approximation: steps that miss the bound at some height are left out") {
  CHECK(to_string(find(mountains(20), within("0.5"), Search::kNormal).z_step) == "1");
}

TEST_CASE("approximation: steps are own ones times a power of two, or an even number of them") {
  const auto near = [](const char* own, const char* bound, int hundredths) {
    return to_string(step_near(*parse_decimal(own), *parse_decimal(bound), hundredths));
  };
  CHECK(near("1", "0", 75) == "1");
  CHECK(near("1", "1", 75) == "2");
  CHECK(near("1", "2", 75) == "2");
  CHECK(near("1", "3", 75) == "4");
  CHECK(near("1", "10", 75) == "8");
  CHECK(near("1", "20", 75) == "16");
  CHECK(near("1", "21.5", 75) == "16");
  CHECK(near("0.01", "0.3", 75) == "0.24");
  CHECK(near("0.25", "1", 140) == "2");
  CHECK(near("5", "1", 75) == "5");
  CHECK(near("0.000000001", "100000000000000000", 75) == "1000000");  // as many as heights have
}

// Most posts are vertices then, and others lie in the middle of edges, where an even step leaves
// whole heights.
TEST_CASE("approximation: within few own steps of a rough terrain, the step is a coarse even one") {
  Raster raster = mountains(65);
  Random random(5);
  for (int64_t& z : raster.heights) z += random.below(12);
  for (const std::string bound : {"1", "2", "3"}) {
    CAPTURE(bound);
    LatticeOptions other = within(bound.c_str());
    other.z_step = parse_decimal(bound == "3" ? "3" : "1");
    const Found chosen = find(raster, within(bound.c_str()));
    CHECK(to_string(chosen.z_step) == (bound == "3" ? "4" : "2"));
    CHECK(static_cast<double>(chosen.bytes) <
          0.97 * static_cast<double>(find(raster, other).bytes));
  }
  CHECK(to_string(find(raster, within("2"), Search::kNormal).z_step) == "4");
}

TEST_CASE("approximation: never below, at most so far above, at a price") {
  for (Raster raster : {mountains(49), dunes(49)}) {
    LatticeOptions lattice = within(raster.decimals == 0 ? "20" : "0.2");
    const Found both = find(raster, lattice);
    CHECK(both.measured.max_below.mantissa > 0);
    lattice.never_below = true;
    const Found above = find(raster, lattice);
    CHECK(above.measured.max_below.mantissa == 0);
    CHECK(above.bytes > both.bytes);
    cut_voids(raster);
    CHECK(find(raster, lattice).measured.max_below.mantissa == 0);
  }
}

TEST_CASE("approximation: scattered points") {
  Random random(41);
  std::string text;
  for (const Point p : uniform_points(3000, random, 1000)) {
    const double height = 30 * std::sin(p.x / 90.0) * std::cos(p.y / 70.0);
    text += std::to_string(p.x / 10.0) + " " + std::to_string(p.y / 10.0) + " " +
            std::to_string(height) + "\n";
  }
  const PointCloud cloud = import_points("cloud", text);
  const size_t bytes = find(cloud, within("0.5")).bytes;
  SimplifyOptions greedy;
  greedy.bounded = true;
  greedy.search = Search::kGreedy;
  CHECK(bytes < encode(approximate(cloud, within("0.5"), greedy).tin, {}).size());
  LatticeOptions above = within("0.5");
  above.never_below = true;
  CHECK(find(cloud, above).measured.max_below.mantissa == 0);
}
