// SPDX-License-Identifier: MIT
// The encoder's public face.
#include "microtin/encoder.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "encoder/files/input.hpp"
#include "encoder/product/document.hpp"
#include "microtin/surface.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/slow.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace microtin::encoder;
using microtin::files::read_file;
using microtin::product::Document;
using microtin::tests::TemporaryFolder;

namespace {

// A cone with a hole.
RasterData cone(uint32_t side) {
  RasterData posts;
  posts.columns = posts.rows = side;
  posts.decimals = 1;
  for (int64_t i = 0; i < int64_t{side} * side; ++i) {
    const int64_t x = i % side, y = i / side, middle = side / 2;
    const int64_t square = (x - middle) * (x - middle) + (y - middle) * (y - middle);
    posts.heights.push_back(x < 3 && y < 3 ? kNoData : 10000 - 7 * square);
  }
  return posts;
}

// Heights within a metre of a dome.
RasterData noisy_dome(uint32_t side) {
  RasterData posts;
  posts.columns = posts.rows = side;
  posts.decimals = 2;
  uint32_t random = 1;
  for (int64_t i = 0; i < int64_t{side} * side; ++i) {
    const int64_t x = i % side - side / 2, y = i / side - side / 2;
    random = (random * 1103515245u + 12345u) % (uint32_t{1} << 31);
    posts.heights.push_back(10000 - (x * x + y * y) / 2 + int64_t{random >> 16} % 201 - 100);
  }
  return posts;
}

Options bounded(const char* bound) {
  Options options;
  options.max_error = bound;
  return options;
}

void write(const std::string& path, const std::vector<uint8_t>& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

TEST_CASE("library: a stream keeps its bound, and contains it") {
  const TemporaryFolder folder;
  Options options = bounded("2.5");
  options.source_name = "a cone";
  options.horizontal_epsg = 25832;
  const Stream stream = encode_stream(SourceTerrain(cone(40)), options);
  CHECK(stream.report.samples == 40 * 40 - 9);
  CHECK(stream.report.bytes == stream.bytes.size());
  CHECK(stream.report.bound == "2.5");
  CHECK(std::stod(stream.report.max_error) <= 2.5);
  CHECK(std::stod(stream.report.rms_error) <= std::stod(stream.report.max_error));
  CHECK(stream.report.vertices < 400);
  CHECK(stream.report.tiles == 0);
  write(folder / "cone.mtin", stream.bytes);
  const Document document(folder / "cone.mtin");
  CHECK(document.stream() != nullptr);
  CHECK(document.vertices() == stream.report.vertices);
  CHECK(document.metadata().source == "a cone");
  CHECK(document.metadata().horizontal_epsg == 25832);
}

TEST_CASE("library: limits of vertices and of bytes are kept" * microtin::tests::kSlow) {
  const SourceTerrain terrain(cone(40));
  Options options;
  options.max_vertices = 60;
  CHECK(encode_stream(terrain, options).report.vertices <= 60);
  options = {};
  options.max_bytes = 400;
  const Stream stream = encode_stream(terrain, options);
  CHECK(stream.bytes.size() <= 400);
  CHECK(std::stod(stream.report.max_error) <= std::stod(stream.report.bound));
}

TEST_CASE(
    "library: a number of vertices is used at least as well as by a bound that takes as many" *
    microtin::tests::kSlow) {
  const SourceTerrain terrain(cone(40));
  for (const char* bound : {"0.3", "0.7", "1.5"}) {
    CAPTURE(bound);
    Options options;
    options.max_error = bound;
    options.max_vertices = 0;
    const Report bounded = encode_stream(terrain, options).report;
    options.max_error.clear();
    options.max_vertices = static_cast<uint32_t>(bounded.vertices);
    const Report budget = encode_stream(terrain, options).report;
    CHECK(budget.vertices <= bounded.vertices);
    CHECK(std::stod(budget.max_error) <= std::stod(bound));
  }
}

TEST_CASE("library: few trials use a number of vertices, though sizes jump where noise begins" *
          microtin::tests::kSlow) {
  const SourceTerrain terrain(noisy_dome(150));
  Options options;
  options.effort = SearchEffort::kFast;
  for (const double bound : {1.15, 1.4}) {
    CAPTURE(bound);
    options.max_error = std::to_string(bound);
    options.max_vertices = 0;
    const Report bounded = encode_stream(terrain, options).report;
    options.max_error.clear();
    options.max_vertices = static_cast<uint32_t>(bounded.vertices);
    const Report found = encode_stream(terrain, options).report;
    CHECK(found.vertices <= bounded.vertices);
    CHECK(std::stod(found.max_error) <= 1.05 * bound);
  }
}

TEST_CASE("library: points, exactly without a bound") {
  PointCloudData points;
  points.z_decimals = 2;
  for (int64_t i = 0; i < 200; ++i) points.points.push_back({i * i % 211, i * 37 % 199, i * 13});
  const Stream stream = encode_stream(SourceTerrain(points), {});
  CHECK(stream.report.vertices == 200);
  CHECK(stream.report.max_error == "0");
  CHECK(stream.report.bound.empty());
}

namespace {

// Pairs of points with a wall between, closer to each other than the steps of a lattice for all.
PointCloudData walls() {
  PointCloudData points;
  points.xy_decimals = 2;
  points.z_decimals = 1;
  for (int64_t i = 0; i < 36; ++i) {
    const int64_t x = i % 6 * 1000000 + i * i * 7919 % 5000, y = i / 6 * 1000000 + i * 97 % 5000;
    points.points.push_back({x, y, i * 37 % 11});
    points.points.push_back({x + 200, y + 100, 600 + i * 53 % 13});
  }
  return points;
}

}  // namespace

TEST_CASE("library: bounds found for a limit hold at the points' own positions") {
  const SourceTerrain terrain(walls());
  for (const uint32_t limit : {30u, 40u}) {
    CAPTURE(limit);
    Options options;
    options.effort = SearchEffort::kFast;
    options.max_vertices = limit;
    const Report few = encode_stream(terrain, options).report;
    REQUIRE(!few.max_error_at_points.empty());
    CHECK(few.vertices <= limit);
    CHECK(std::stod(few.max_error_at_points) <= std::stod(few.bound));
    options.bound_at = BoundAt::kLattice;
    const Report lattice = encode_stream(terrain, options).report;
    CHECK(std::stod(lattice.max_error) <= std::stod(lattice.bound));
    CHECK(std::stod(few.max_error_at_points) <= std::stod(lattice.max_error_at_points));
  }
}

TEST_CASE("library: never below the points where they truly lie, by limits, too") {
  const SourceTerrain terrain(walls());
  Options options;
  options.effort = SearchEffort::kFast;
  options.never_below = true;
  options.max_bytes = 330;
  const Report by_bytes = encode_stream(terrain, options).report;
  CHECK(by_bytes.bytes <= 330);
  CHECK(by_bytes.max_below == "0");
  CHECK(by_bytes.max_below_at_points == "0");
  options.bound_at = BoundAt::kLattice;
  CHECK(encode_stream(terrain, options).report.max_below_at_points != "0");  // the check can fail
}

TEST_CASE("library: packs are files, whole or not there" * microtin::tests::kSlow) {
  const TemporaryFolder folder;
  Options options;
  options.max_error = "1";
  options.tile_vertices = 40;
  const Report report = encode_pack(SourceTerrain(cone(60)), options, folder / "cone.mtp");
  CHECK(report.tiles > 1);
  CHECK(report.samples == 60 * 60 - 9);
  const Document document(folder / "cone.mtp");
  CHECK(document.pack() != nullptr);
  CHECK(document.bytes() == report.bytes);
  CHECK(document.vertices() == report.vertices);
  CHECK(document.tiles() == report.tiles);
  CHECK(document.model().triangles.size() > 100);
}

TEST_CASE("library: a pack without a number of vertices has tiles of the usual one") {
  const TemporaryFolder folder;
  const SourceTerrain terrain(noisy_dome(70));
  Options options;
  options.max_error = "0";
  options.effort = SearchEffort::kFast;
  const Report report = encode_pack(terrain, options, folder / "usual.mtp");
  CHECK(report.tiles > 1);
  options.tile_vertices = kUsualTileVertices;
  encode_pack(terrain, options, folder / "same.mtp");
  CHECK(read_file(folder / "usual.mtp") == read_file(folder / "same.mtp"));
  options.tile_vertices = 15;
  CHECK_THROWS_WITH(encode_pack(terrain, options, folder / "few.mtp"),
                    "tile_vertices: use 16 to 16777216, or 0 for the default");
}

TEST_CASE("library: work that is cancelled leaves nothing") {
  const TemporaryFolder folder;
  uint32_t calls = 0;
  double last = 0;
  Callbacks callbacks;
  callbacks.progress = [&](double done) {
    CHECK(done >= 0);
    CHECK(done <= 1);
    last = done;
  };
  callbacks.cancelled = [&] { return ++calls > 3; };
  const SourceTerrain terrain(cone(60));
  CHECK_THROWS_AS(encode_stream(terrain, bounded("0.3"), callbacks), Cancelled);
  Options bytes;
  bytes.max_bytes = 500;
  calls = 0;
  CHECK_THROWS_AS(encode_stream(terrain, bytes, callbacks), Cancelled);
  Options options;
  options.max_error = "1";
  options.tile_vertices = 16;
  calls = 0;
  CHECK_THROWS_AS(encode_pack(terrain, options, folder / "none.mtp", callbacks), Cancelled);
  CHECK(std::filesystem::is_empty(folder.path()));
  callbacks.cancelled = {};
  encode_stream(terrain, bounded("0.3"), callbacks);
  CHECK(last > 0.5);
}

TEST_CASE("library: axes in lowest terms or not are the same, those that no header holds refused") {
  const TemporaryFolder folder;
  Options options;
  options.max_error = "1";
  options.tile_vertices = 40;
  const auto encoded = [&](uint64_t numerator, uint64_t denominator) {
    RasterData posts = cone(9);
    posts.x = {0, numerator, denominator};
    const SourceTerrain terrain(std::move(posts));
    encode_pack(terrain, options, folder / "cone.mtp");
    return encode_stream(terrain, bounded("1")).bytes;
  };
  constexpr uint64_t kLarge = uint64_t{1} << 42;
  const std::vector<uint8_t> half = encoded(1, 2);
  const uint64_t pack = Document(folder / "cone.mtp").bytes();
  CHECK(encoded(kLarge, 2 * kLarge) == half);
  CHECK(Document(folder / "cone.mtp").bytes() == pack);
  CHECK_THROWS_AS(encoded(kLarge, 1), std::runtime_error);
  CHECK_THROWS_AS(encoded(1, kLarge), std::runtime_error);
}

TEST_CASE("library: positions beyond 360 or 90 degrees are refused, of posts and of points") {
  const TemporaryFolder folder;
  const PointCloudData points{{{471, 1582, 3}, {472, 1582, 4}, {471, 1583, 6}}, 1, 0, ""};
  RasterData posts = cone(8);
  posts.y = {158, 1, 1};
  Options pack;
  pack.tile_vertices = 100;
  for (const SourceTerrain& terrain : {SourceTerrain(points), SourceTerrain(posts)}) {
    for (const bool is_known : {true, false}) {
      Options options;
      options.units = pack.units = is_known ? "degree:metre" : "metre:metre";
      options.max_error = pack.max_error = "100";
      options.bound_at = pack.bound_at = BoundAt::kLattice;
      const auto stream = [&] { encode_stream(terrain, options); };
      const auto packed = [&] { encode_pack(terrain, pack, folder / "p.mtp"); };
      if (is_known) {
        CHECK_THROWS_WITH(stream(), doctest::Contains("is beyond 90 degrees"));
        CHECK_THROWS_WITH(packed(), doctest::Contains("is beyond 90 degrees"));
      } else {
        CHECK_NOTHROW(stream());
        CHECK_NOTHROW(packed());
      }
    }
  }
}

TEST_CASE("library: units are converted and depths turned, in streams and packs alike") {
  const TemporaryFolder folder;
  RasterData posts = cone(9);
  posts.heights.assign(81, 100);
  posts.heights[40] = 500;
  posts.z_unit = "cm";
  posts.wkt = R"(LOCAL_CS["a",UNIT["m",1]])";
  Options options;
  options.tile_vertices = 100;
  options.depths = true;
  const Report report = encode_pack(SourceTerrain(posts), options, folder / "t.mtp");
  CHECK(report.warnings == std::vector<std::string>{
                               "heights in the unit centimetre are converted to metre: times 0.01",
                               "depths are turned into heights"});
  const Surface pack = Surface::from_file(folder / "t.mtp");
  CHECK(pack.info().lowest == -0.5);
  CHECK(pack.info().highest == -0.1);
  CHECK(pack.info().vertical_unit == microtin::encoder::Unit::kMetre);
  posts.wkt +=
      R"(,VERT_CS["MSL depth",UNIT["metre",1],AXIS["Depth",DOWN],AUTHORITY["EPSG","5715"]])";
  Options stream;
  stream.units = "metre:metre";
  CHECK_THROWS_AS(encode_stream(SourceTerrain(posts), stream), std::runtime_error);
  stream.depths = true;
  const Stream made = encode_stream(SourceTerrain(posts), stream);
  CHECK(made.report.warnings ==
        std::vector<std::string>{"heights are taken as metre; the file says centimetre",
                                 "depths are turned into heights: EPSG 5715 becomes EPSG 5714"});
  PointCloudData points;
  points.points = {{0, 0, 1}, {9, 0, 2}, {0, 9, 3}};
  points.z_unit = "furlong";
  stream.depths = false;
  stream.units.clear();
  CHECK_THROWS_AS(encode_stream(SourceTerrain(points), stream), std::runtime_error);
}

TEST_CASE("library: messages name options as Options does, or as the caller spells them") {
  Options options;
  options.xy_step = "2";
  options.tile_vertices = 5;
  try {
    encode_pack(SourceTerrain(cone(9)), options, "none.mtp");
    FAIL("no error");
  } catch (const std::runtime_error& error) {
    CHECK(std::string(error.what()) == "tile_vertices: use 16 to 16777216, or 0 for the default");
    CHECK(message_of(error, [](const std::string& name) { return "<" + name + ">"; }) ==
          "<tile_vertices>: use 16 to 16777216, or 0 for the default");
  }
  CHECK(message_of(std::runtime_error("max_error"), [](const std::string&) { return ""; }) ==
        "max_error");
}

TEST_CASE("library: a pack's margins are the largest of its tiles', points and streams") {
  const TemporaryFolder folder;
  Options options;
  options.max_error = "3";
  options.tile_vertices = 40;
  encode_pack(SourceTerrain(cone(60)), options, folder / "cone.mtp");
  const Surface pack = Surface::from_file(folder / "cone.mtp");
  double below = 0, above = 0;
  for (uint32_t row = 0; row < pack.info().tile_rows; ++row) {
    for (uint32_t column = 0; column < pack.info().tile_columns; ++column) {
      const TileMargins margins = pack.tile_margins(column, row);
      below = std::max(below, std::stod(margins.max_below_everywhere));
      above = std::max(above, std::stod(margins.max_above_everywhere));
    }
  }
  CHECK(below == std::stod(pack.info().max_below_everywhere));
  CHECK(above == std::stod(pack.info().max_above_everywhere));
  CHECK_THROWS_AS(pack.tile_margins(pack.info().tile_columns, 0), std::out_of_range);
  options.tile_vertices = 0;
  write(folder / "cone.mtin", encode_stream(SourceTerrain(cone(60)), options).bytes);
  const Surface stream = Surface::from_file(folder / "cone.mtin");
  CHECK(stream.tile_margins(0, 0).max_below_everywhere == stream.info().max_below_everywhere);
  PointCloudData points;
  for (int64_t i = 0; i < 100; ++i) points.points.push_back({i % 10, i / 10, i * i % 7});
  write(folder / "points.mtin", encode_stream(SourceTerrain(points), {}).bytes);
  CHECK(Surface::from_file(folder / "points.mtin").tile_margins(0, 0).max_above_everywhere.empty());
}

TEST_CASE("library: a raster's metadata are notes of streams and packs, an option wins") {
  const TemporaryFolder folder;
  RasterData posts = cone(9);
  posts.items = {{"TIFFTAG_COPYRIGHT", "the survey"}, {"COORDINATE_EPOCH", "2020.5"}};
  Options options;
  options.epoch = "2015";
  encode_pack(SourceTerrain(posts), options, folder / "a.mtp");
  const Stream stream = encode_stream(SourceTerrain(posts), options);
  write(folder / "a.mtin", stream.bytes);
  for (const char* const name : {"a.mtin", "a.mtp"}) {
    const Surface surface = Surface::from_file(folder / name);
    CHECK(surface.info().attribution == "the survey");
    CHECK(surface.info().epoch == "2015");
    CHECK(surface.info().license.empty());
  }
  posts.items["TIFFTAG_COPYRIGHT"] = std::string(2000, 'c');
  const std::vector<std::string> warnings =
      encode_stream(SourceTerrain(posts), options).report.warnings;
  CHECK(std::count(warnings.begin(), warnings.end(),
                   "the file's TIFFTAG_COPYRIGHT has 2000 bytes, and is not noted") == 1);
}

TEST_CASE("library: what makes no sense is refused with a sentence") {
  const auto error_of = [](RasterData posts, const Options& options) -> std::string {
    try {
      encode_stream(SourceTerrain(std::move(posts)), options);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "none";
  };
  RasterData posts = cone(9);
  CHECK(error_of(posts, bounded("1")) == "none");
  CHECK(error_of(posts, bounded("-1")) ==
        "max_error: '-1' is not allowed; use a decimal number from 0 up");
  CHECK(error_of(posts, bounded("x")) ==
        "max_error: 'x' is not allowed; use a decimal number from 0 up");
  Options options = bounded("1");
  options.max_bytes = 100;
  CHECK(error_of(posts, options) ==
        "max_error, max_vertices and max_bytes exclude each other; use one");
  options = bounded("1");
  options.max_degree = 33;
  CHECK(error_of(posts, options) == "max_degree: use 6 to 32, or 0 for the default");
  options = {};
  options.never_below = true;
  CHECK(error_of(posts, options) == "never_below needs max_error or max_bytes");
  options = bounded("1");
  options.route_edge_error = "9";
  CHECK(error_of(posts, options) == "route_edge_error needs route");
  options = {};
  options.date = "yesterday";
  CHECK(error_of(posts, options) ==
        "date: 'yesterday' is not allowed; use a date such as 2026, 2026-11 or 2026-11-21");
  posts.heights.pop_back();
  CHECK(error_of(posts, {}) == "there are 80 heights; use columns times rows, 81");
  posts.heights.push_back(kNoData + 1);
  CHECK(error_of(posts, {}) == "a height is beyond 10^18; use fewer decimals");
  posts.heights.back() = 0;
  posts.x.denominator = 0;
  CHECK(error_of(posts, {}) == "an axis has no step; set numerator and denominator above 0");
  CHECK_THROWS_AS(SourceTerrain::from_file("/nowhere/at.asc"), std::runtime_error);
}
