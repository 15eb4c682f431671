// SPDX-License-Identifier: MIT
// Bounds that hold between the posts of a raster, too, looked at in dense samples of every cell.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
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
constexpr int kSamples = (kParts + 1) * (kParts + 1);

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

bool has_surface(int column, int row) {
  return !is_void(column, row) && !is_void(column + 1, row) && !is_void(column, row + 1) &&
         !is_void(column + 1, row + 1);
}

// In a cell, from 0 to 1.
struct Place {
  double u, v;
};

Place place_of(int sample) {
  const int column_part = sample % (kParts + 1), row_part = sample / (kParts + 1);
  return {static_cast<double>(column_part) / kParts, static_cast<double>(row_part) / kParts};
}

// The heights at all samples of a row of cells, cell by cell.
std::vector<double> heights_along(const library::Surface& surface, int row) {
  std::vector<double> x, y;
  for (int column = 0; column + 1 < kPosts; ++column) {
    for (int sample = 0; sample < kSamples; ++sample) {
      const Place at = place_of(sample);
      x.push_back(10 * (column + at.u));
      y.push_back(10 * (row + at.v));
    }
  }
  std::vector<double> heights(x.size());
  surface.heights(x.size(), x.data(), y.data(), heights.data());
  return heights;
}

Range compare(const std::string& file, const PostHeight& height, const PostHeight& bound) {
  const library::Surface surface = library::Surface::from_file(file);
  Range range;
  for (int row = 0; row + 1 < kPosts; ++row) {
    const std::vector<double> heights = heights_along(surface, row);
    for (int column = 0; column + 1 < kPosts; ++column) {
      if (!has_surface(column, row)) continue;
      const double allowed = std::max({bound(column, row), bound(column + 1, row),
                                       bound(column, row + 1), bound(column + 1, row + 1)});
      const double south_west = height(column, row), south_east = height(column + 1, row),
                   north_west = height(column, row + 1), north_east = height(column + 1, row + 1);
      for (int sample = 0; sample < kSamples; ++sample) {
        const auto [u, v] = place_of(sample);
        const double bilinear = (south_west * (1 - u) + south_east * u) * (1 - v) +
                                (north_west * (1 - u) + north_east * u) * v;
        const double above = heights[static_cast<std::size_t>(column) * kSamples +
                                     static_cast<std::size_t>(sample)] -
                             bilinear;
        REQUIRE_FALSE(std::isnan(above));
        range.lowest = std::min(range.lowest, above);
        range.highest = std::max(range.highest, above);
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

std::string encode(const Session& session, const std::string& options,
                   const std::string& output = "t.mtin") {
  const Session::Result made = session.run(
      join({"encode t.asc --units metre --bound-at everywhere -o ", output, " ", options}));
  REQUIRE_MESSAGE(made.code == 0, made.err);
  const Session::Result verified = session.run(join({"verify ", output, " t.asc --units metre"}));
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

TEST_CASE("bound everywhere: in packs it holds on both sides of all borders and at all corners") {
  const Session session;
  write_raster(session, "t.asc", rough);
  const std::string file = session.folder() + "/t.mtp";
  for (const char* size : {"2", "3", "7", "20", "40"}) {
    for (const char* bound : {"6", "12"}) {
      const std::string options =
          join({"--max-error ", bound, " --fast --z-step 0.5 --tile-size ", size});
      CHECK(contains(encode(session, options, "t.mtp"), "the bound holds there, too"));
      const Range range = compare(file, rough, same(std::stod(bound)));
      CHECK(range.largest_excess <= kRounding);
      CHECK(range.largest_excess > -3);
    }
  }
  encode(session, "--max-error 14 --never-below --tile-size 9", "t.mtp");
  const Range above = compare(file, rough, same(14));
  CHECK(above.lowest >= -kRounding);
  CHECK(above.highest <= 14 + kRounding);
  REQUIRE(session.run("encode t.asc --units metre --max-error 6 -o t.mtp --tile-size 9").code == 0);
  CHECK(compare(file, rough, same(6)).largest_excess > 1);
}

TEST_CASE("bound everywhere: tiles keep what cells that bend nearly too much leave") {
  const Session session;
  const std::string file = session.folder() + "/t.mtp";
  for (int seed = 3; seed <= 7; ++seed) {
    const PostHeight height = [&](int column, int row) {
      return std::round(10 * (90 + seed * std::sin(column * 0.4 + row * 0.07 * seed) +
                              5 * std::cos(row * 0.5 - column * 0.05 * seed))) /
             10;
    };
    write_raster(session, "t.asc", height);
    double bend = 0;
    for (int row = 0; row + 1 < kPosts; ++row) {
      for (int column = 0; column + 1 < kPosts; ++column) {
        bend = std::max(bend, std::abs(height(column, row) - height(column + 1, row) -
                                       height(column, row + 1) + height(column + 1, row + 1)));
      }
    }
    const double bound = std::ceil(bend / 4 * 10 + 1) / 10;  // just enough
    for (const char* options : {" --tile-size 2", " --tile-size 5"}) {
      encode(session, join({"--z-step 0.01 --fast --max-error ", std::to_string(bound), options}),
             "t.mtp");
      CHECK(compare(file, height, same(bound)).largest_excess <= kRounding);
    }
  }
}

TEST_CASE("bound everywhere: a pack in shards is the pack, and bounds of posts hold in its cells") {
  const Session session;
  write_raster(session, "t.asc", rough);
  const PostHeight bound = [](int column, int) { return column < 20 ? 5 : 14; };
  write_raster(session, "map.asc", [&](int column, int row) { return bound(column, row); });
  const std::string options =
      "--error-map map.asc --max-error 14 --z-step 0.5 --tile-size 10 --fast";
  REQUIRE(session.run("encode t.asc --units metre --bound-at everywhere -o whole.mtp " + options)
              .code == 0);
  CHECK(compare(session.folder() + "/whole.mtp", rough, bound).largest_excess <= kRounding);
  for (const char* part : {"0:6", "7:15"}) {
    REQUIRE(session
                .run(join({"encode t.asc --units metre --bound-at everywhere ", options,
                           " --shard ", part, " -o ", std::string(part).substr(0, 1), ".shard"}))
                .code == 0);
  }
  REQUIRE(session.run("merge 0.shard 7.shard -o t.mtp").code == 0);
  CHECK(session.read("t.mtp") == session.read("whole.mtp"));
  const Session::Result other =
      session.run("encode t.asc --units metre " + options + " --shard 7:15 -o other.shard");
  REQUIRE(other.code == 0);
  CHECK(contains(session.failure("merge 0.shard other.shard -o t.mtp"), "other options"));
}

TEST_CASE("bound everywhere: an update keeps it, and leaves an unchanged pack as it is") {
  const Session session;
  write_raster(session, "t.asc", rough);
  encode(session, "--max-error 9 --z-step 0.5 --tile-size 8 --fast", "old.mtp");
  REQUIRE(session.run("update old.mtp t.asc --units metre -o t.mtp").code == 0);
  CHECK(session.read("t.mtp") == session.read("old.mtp"));
  const PostHeight changed = [](int column, int row) {
    return rough(column, row) + (std::hypot(column - 13, row - 14) < 3 ? 7 : 0);
  };
  write_raster(session, "t.asc", changed);
  const Session::Result updated =
      session.run("update old.mtp t.asc --units metre --tile-vertices 500 -o t.mtp");
  REQUIRE_MESSAGE(updated.code == 0, updated.err);
  CHECK_FALSE(contains(updated.out, "kept: 25 of 25"));
  CHECK(compare(session.folder() + "/t.mtp", changed, same(9)).largest_excess <= kRounding);
}

TEST_CASE("bound everywhere: a pack that keeps it by chance can be updated without it") {
  const Session session;
  write_raster(session, "t.asc", [](int column, int row) { return 50 + (column + row) % 2; });
  REQUIRE(session.run("encode t.asc --units metre --max-error 9 --z-step 1 -o old.mtp").code == 0);
  write_raster(session, "t.asc",
               [](int column, int row) { return column == 7 && row == 9 ? 200 : 50; });
  const std::string update = "update old.mtp t.asc --units metre --tile-vertices 900 -o t.mtp";
  CHECK(contains(session.failure(update), "--bound-at points"));
  CHECK(session.run(update + " --bound-at points").code == 0);
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
      session.failure("encode p.xyz --units metre --max-error 1 --bound-at everywhere -o p.mtp"),
      "is for rasters"));
  CHECK(contains(session.failure("encode t.asc --units metre --max-error 30 --xy-step 2 "
                                 "--bound-at everywhere -o t.mtin"),
                 "--xy-step"));
}

}  // namespace microtin::everywhere_bound_test
