// SPDX-License-Identifier: MIT
// Bounds that hold between the posts of a raster, too, looked at in dense samples of every cell.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "microtin/surface.hpp"
#include "tests/support/files.hpp"
#include "tests/support/join.hpp"
#include "tests/support/session.hpp"

using namespace microtin::tests;
namespace library = microtin::encoder;

// A namespace of its own: sources of a folder may be compiled as one.
namespace microtin::everywhere_bound_test {
namespace {

constexpr int kPosts = 41;  // on a side, 10 apart, from 0 on
constexpr int kParts = 8;   // of a cell's side that samples lie at

using PostHeight = std::function<double(int column, int row)>;

double rough(int column, int row) {
  return std::round(200 + 60 * std::sin(column * 0.31) * std::cos(row * 0.23) +
                    (column * 37 + row * 101 + column * row * 13) % 9);
}

bool is_void(int column, int row) {
  return column > 30 && column < 35 && row > 8 && row < 14;
}

void write_raster(const Session& session, const std::string& file, const PostHeight& height) {
  std::string text = join({"ncols ", std::to_string(kPosts), "\nnrows ", std::to_string(kPosts),
                           "\nxllcenter 0\nyllcenter 0\ncellsize 10\nnodata_value -9\n"});
  for (int row = kPosts - 1; row >= 0; --row) {
    for (int column = 0; column < kPosts; ++column) {
      const double z = is_void(column, row) ? -9 : height(column, row);
      text += std::to_string(z);
      text += column + 1 < kPosts ? ' ' : '\n';
    }
  }
  session.write(file, text);
}

// How far a surface is above (below 0: below) the posts' bilinear surface, less what is allowed.
struct Range {
  double lowest = 0, highest = 0, largest_excess = -1e9;
};

Range compare(const std::string& file, const PostHeight& height, const PostHeight& bound) {
  const library::Surface surface = library::Surface::from_file(file);
  Range range;
  for (int row = 0; row + 1 < kPosts; ++row) {
    for (int column = 0; column + 1 < kPosts; ++column) {
      if (is_void(column, row) || is_void(column + 1, row) || is_void(column, row + 1) ||
          is_void(column + 1, row + 1)) {
        continue;
      }
      for (int part = 0; part < (kParts + 1) * (kParts + 1); ++part) {
        const int column_part = part % (kParts + 1), row_part = part / (kParts + 1);
        const double u = static_cast<double>(column_part) / kParts,
                     v = static_cast<double>(row_part) / kParts;
        const auto bilinear = [&](const PostHeight& at) {
          return (at(column, row) * (1 - u) + at(column + 1, row) * u) * (1 - v) +
                 (at(column, row + 1) * (1 - u) + at(column + 1, row + 1) * u) * v;
        };
        const double x = 10 * (column + u), y = 10 * (row + v);
        double z = 0;
        surface.heights(1, &x, &y, &z);
        REQUIRE_FALSE(std::isnan(z));
        const double above = z - bilinear(height);
        range.lowest = std::min(range.lowest, above);
        range.highest = std::max(range.highest, above);
        const double allowed = std::max({bound(column, row), bound(column + 1, row),
                                         bound(column, row + 1), bound(column + 1, row + 1)});
        range.largest_excess = std::max(range.largest_excess, std::abs(above) - allowed);
      }
    }
  }
  return range;
}

PostHeight same(double bound) {
  return [bound](int, int) { return bound; };
}

constexpr double kRounding = 1e-6;

std::string encode(const Session& session, const std::string& options) {
  const Session::Result made =
      session.run("encode t.asc --units metre --bound-at everywhere -o t.mtin " + options);
  REQUIRE_MESSAGE(made.code == 0, made.err);
  const Session::Result verified = session.run("verify t.mtin t.asc --units metre");
  CHECK_MESSAGE(verified.code == 0, verified.err);
  return made.out;
}

}  // namespace

TEST_CASE("bound everywhere: no place between posts is farther off, and at posts alone some are") {
  const Session session;
  write_raster(session, "t.asc", rough);
  const std::string file = session.folder() + "/t.mtin";
  for (const char* options : {"", " --fast", " --z-step 1", " --coding dense"}) {
    CHECK(contains(encode(session, std::string("--max-error 6") + options), "the bound holds"));
    const Range range = compare(file, rough, same(6));
    CHECK(range.largest_excess <= kRounding);
    CHECK(range.largest_excess > -0.5);  // the bound is used
  }
  REQUIRE(session.run("encode t.asc --units metre --max-error 6 -o t.mtin").code == 0);
  CHECK(compare(file, rough, same(6)).largest_excess > 1);
}

TEST_CASE("bound everywhere: with never-below no place is below the posts' surface") {
  const Session session;
  write_raster(session, "t.asc", rough);
  encode(session, "--max-error 12 --never-below");
  const Range range = compare(session.folder() + "/t.mtin", rough, same(12));
  CHECK(range.lowest >= -kRounding);
  CHECK(range.highest <= 12 + kRounding);
  REQUIRE(session.run("encode t.asc --units metre --max-error 12 --never-below -o t.mtin").code ==
          0);
  CHECK(compare(session.folder() + "/t.mtin", rough, same(12)).lowest < -0.5);
}

TEST_CASE("bound everywhere: in a cell the largest of its posts' own bounds holds") {
  const Session session;
  write_raster(session, "t.asc", rough);
  const PostHeight bound = [](int column, int) { return column < 20 ? 5 : 14; };
  write_raster(session, "map.asc", [&](int column, int row) { return bound(column, row); });
  const Session::Result made = session.run(
      "encode t.asc --units metre --bound-at everywhere --error-map map.asc --max-error 14 -o "
      "t.mtin");
  REQUIRE_MESSAGE(made.code == 0, made.err);
  const Range range = compare(session.folder() + "/t.mtin", rough, bound);
  CHECK(range.largest_excess <= kRounding);
  CHECK(range.highest > 6);
}

TEST_CASE("bound everywhere: a limit finds the smallest bound that holds there") {
  const Session session;
  write_raster(session, "t.asc", rough);
  const std::string file = session.folder() + "/t.mtin";
  for (const char* limit : {"--max-bytes 500", "--max-vertices 150"}) {
    encode(session, limit);
    const double bound = std::stod(library::Surface::from_file(file).info().bound);
    CHECK(compare(file, rough, same(bound)).largest_excess <= kRounding);
  }
  encode(session, "--max-bytes 700 --never-below");
  CHECK(compare(file, rough, same(0)).lowest >= -kRounding);
}

TEST_CASE("bound everywhere: refused where cells bend too much, naming the worst, and for points") {
  const Session session;
  const PostHeight spike = [](int column, int row) { return column == 7 && row == 9 ? 90 : 5; };
  write_raster(session, "t.asc", spike);
  const std::string refused =
      session.failure("encode t.asc --units metre --max-error 5 --bound-at everywhere -o t.mtin");
  CHECK(contains(refused, "x 60, y 80 bends by 85"));
  CHECK(contains(refused, "21.25"));
  encode(session, "--max-error 22");  // a quarter is 21.25
  CHECK(compare(session.folder() + "/t.mtin", spike, same(22)).largest_excess <= kRounding);
  session.write("p.xyz", "0 0 1\n9 0 2\n0 9 3\n9 9 7\n");
  CHECK(contains(
      session.failure("encode p.xyz --units metre --max-error 1 --bound-at everywhere -o p.mtin"),
      "is for rasters"));
  CHECK(contains(
      session.failure("encode t.asc --units metre --max-error 30 --bound-at everywhere -o t.mtp"),
      "is for streams"));
  CHECK(contains(session.failure("encode t.asc --units metre --max-error 30 --xy-step 2 "
                                 "--bound-at everywhere -o t.mtin"),
                 "--xy-step"));
}

}  // namespace microtin::everywhere_bound_test
