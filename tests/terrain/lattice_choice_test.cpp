// SPDX-License-Identifier: MIT
// The steps and offsets that sources get.
#include "encoder/terrain/lattice_choice.hpp"

#include <doctest/doctest.h>

#include <random>

#include "encoder/base/error.hpp"
#include "tests/support/cloud_text.hpp"

using namespace microtin::tests;

namespace {

Lattice choose(const std::string& points, const LatticeOptions& options = {}) {
  return choose_lattice(cloud_of(points), options);
}

std::string text_of(const Axis& axis) {
  return std::to_string(axis.offset) + "+" + std::to_string(axis.numerator) + "k/" +
         std::to_string(axis.denominator);
}

LatticeOptions steps(const char* xy, const char* z) {
  LatticeOptions options;
  options.xy_step = parse_decimal(xy);
  options.z_step = parse_decimal(z);
  return options;
}

Raster raster_of(uint32_t width, uint32_t height) {
  Raster raster;
  raster.width = width;
  raster.height = height;
  raster.heights.assign(size_t{width} * height, 7);
  return raster;
}

}  // namespace

TEST_CASE("integers that fit 16 bits keep their values") {
  const Lattice lattice = choose("0 5 -32768\n65535 7 32767");
  CHECK(text_of(lattice.placement.x) == "0+1k/1");
  CHECK(text_of(lattice.placement.y) == "0+1k/1");
  CHECK(text_of(lattice.placement.z) == "0+1k/1");
}

TEST_CASE("decimals keep their step, an offset takes what 16 bits do not hold") {
  const Lattice lattice = choose("84917.404 447423.234 0.101\n84950.080 447422.982 0.086");
  CHECK(text_of(lattice.placement.x) == "84917404+1k/1000");
  CHECK(text_of(lattice.placement.y) == "447422982+1k/1000");
  CHECK(text_of(lattice.placement.z) == "0+1k/1000");
  // Heights from 40000 to 100000: the lowest at -32768.
  CHECK(text_of(choose("0 0 40000\n1 1 100000").placement.z) == "72768+1k/1");
  CHECK(text_of(choose("0 0 40000\n1 1 50000").placement.z) == "40000+1k/1");
}

TEST_CASE("a range too wide for the source's step gets the finest of 1, 2, 5 that holds it") {
  CHECK(text_of(choose("0 0\n65535 65536").placement.x) == "0+2k/1");  // x and y share the step
  CHECK(text_of(choose("0 0\n65536 0").placement.y) == "0+2k/1");
  CHECK(text_of(choose("0 0\n131071 0").placement.x) == "0+5k/1");
  CHECK(text_of(choose("0 0\n400000 0").placement.x) == "0+10k/1");
  CHECK(text_of(choose("0 0 0.1\n1 1 6553.6").placement.z) == "32769+1k/10");
  CHECK(text_of(choose("0 0 0\n1 1 6553.6").placement.z) == "32768+1k/5");
}

TEST_CASE("explicit steps hold, or are refused") {
  const Lattice lattice = choose("10 20 300\n16 26 308", steps("2", "4"));
  CHECK(text_of(lattice.placement.x) == "0+2k/1");
  CHECK(text_of(lattice.placement.z) == "0+4k/1");
  CHECK(text_of(choose("1 2 3\n4 5 6", steps("0.25", "0.001")).placement.x) == "0+1k/4");
  CHECK_THROWS_WITH_AS(
      choose("0 0\n65536 0", steps("1", "1")),
      "xy_step 1 is too fine: 16 bits do not hold the source's range in such steps; use 2 or more",
      Error);
  CHECK_THROWS_AS(choose("0 0 0\n1 1 65536", steps("1", "1")), Error);
  CHECK_NOTHROW(choose("0 0 0\n1 1 65535", steps("1", "1")));
  CHECK_THROWS_WITH_AS(choose("0 0", steps("0", "1")),
                       "xy_step 0 is out of range; use a number above 0, up to 1000000000", Error);
  CHECK_THROWS_AS(choose("0 0", steps("1", "1e12")), Error);
}

TEST_CASE("numbers that all lie off the step's multiples by the same rest stay exact") {
  const Lattice lattice = choose("0.5 10.5 1\n1.5 12.5 1.5", steps("1", "1"));
  CHECK(text_of(lattice.placement.x) == "1+2k/2");
  CHECK(text_of(lattice.placement.y) == "1+2k/2");
  CHECK(text_of(lattice.placement.z) == "0+1k/1");  // no common rest
}

TEST_CASE("rasters: steps are posts, however far apart posts are") {
  Raster raster = raster_of(65536, 1);
  raster.x = {8400, 1, 1200};
  CHECK(text_of(choose_lattice(raster, {}).placement.x) == "8400+1k/1200");
  CHECK(text_of(choose_lattice(raster, steps("2", "1")).placement.x) == "4200+1k/600");
  CHECK_THROWS_AS(choose_lattice(raster_of(65537, 1), {}), Error);
  CHECK_THROWS_AS(choose_lattice(raster_of(1, 65537), {}), Error);
  CHECK_NOTHROW(choose_lattice(raster_of(1, 65537), steps("2", "1")));
}

TEST_CASE("a raster without heights has no lattice") {
  Raster raster = raster_of(2, 2);
  raster.heights.assign(4, kVoidHeight);
  CHECK_THROWS_WITH_AS(choose_lattice(raster, {}), "there is no height", Error);
}

TEST_CASE("placing a number and mapping it to the lattice is the same as map_between") {
  std::mt19937_64 random(3);
  for (int round = 0; round < 300; ++round) {
    PointCloud cloud;
    cloud.xy_decimals = static_cast<int>(random() % 6);
    cloud.z_decimals = static_cast<int>(random() % 6);
    const auto spread = static_cast<int64_t>(1 + random() % 10000000);
    const auto base = static_cast<int64_t>(random() % 1000000000) - 500000000;
    for (int i = 0; i < 5; ++i) {
      const auto any = [&] { return base + static_cast<int64_t>(random()) % spread; };
      cloud.points.push_back({any(), any(), any()});
    }
    const Source source = cloud;
    const Lattice lattice = choose_lattice(source, {});
    const Placement numbers = placement_of(source);
    const LatticeMap x = map_between(numbers.x, lattice.placement.x);
    const LatticeMap z = map_between(numbers.z, lattice.placement.z);
    for (const SourcePoint& p : cloud.points) {
      CHECK((x.nearest(p.x) == lattice.x.nearest(p.x)));
      CHECK((z.nearest(p.z) == lattice.z.nearest(p.z)));
      CHECK((lattice.x.nearest(p.x) >= 0 && lattice.x.nearest(p.x) <= 65535));
      CHECK((lattice.z.nearest(p.z) >= -32768 && lattice.z.nearest(p.z) <= 32767));
    }
  }
}
