// SPDX-License-Identifier: MIT
// Surfaces read back by the public face, in C++ and in C.
#include "microtin/surface.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <stdexcept>

#include "microtin/encoder.h"
#include "microtin/encoder.hpp"
#include "tests/support/files.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/slow.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace microtin::encoder;
using microtin::tests::TemporaryFolder;
using microtin::tests::write_file;

namespace {

constexpr double kRounding = 1e-9;  // of differences of binary numbers
constexpr uint32_t kBowlColumns = 60, kBowlRows = 45;
constexpr Transform kTransform{599995, 10, 0, 5000005, 0, -10};

// A bowl in tenths of metres with a hole in the north-west; row 0 is the northernmost.
std::vector<double> bowl() {
  std::vector<double> heights;
  for (int row = 0; row < int{kBowlRows}; ++row) {
    for (int column = 0; column < int{kBowlColumns}; ++column) {
      const int square = (column - 30) * (column - 30) + (row - 20) * (row - 20);
      heights.push_back(column < 4 && row < 4 ? std::nan("") : (3 * square + row) * 0.1);
    }
  }
  return heights;
}

SourceTerrain bowl_terrain() {
  return SourceTerrain(raster_from_cells(kBowlColumns, kBowlRows, bowl().data(), kTransform));
}

std::string stream_file(const TemporaryFolder& folder, const Options& options) {
  std::string path = folder / "bowl.mtin";
  write_file(path, encode_stream(bowl_terrain(), options).bytes);
  return path;
}

std::string pack_file(const TemporaryFolder& folder) {
  std::string path = folder / "bowl.mtp";
  Options options;
  options.max_error = "1";
  options.tile_vertices = 64;
  options.tile_size = 16;
  encode_pack(bowl_terrain(), options, path);
  return path;
}

// The largest distance from the bowl of heights in its order; voids must be the same.
double largest_error(const std::vector<double>& heights) {
  const std::vector<double> expected = bowl();
  REQUIRE(heights.size() == expected.size());
  double largest = 0;
  for (size_t i = 0; i < heights.size(); ++i) {
    REQUIRE(std::isnan(heights[i]) == std::isnan(expected[i]));
    if (!std::isnan(heights[i])) largest = std::max(largest, std::fabs(heights[i] - expected[i]));
  }
  return largest;
}

std::vector<double> raster_of(const Surface& surface) {
  const Grid& grid = surface.info().source;
  std::vector<double> heights(size_t{grid.columns} * grid.rows);
  surface.heights(grid, {0, 0, grid.columns, grid.rows}, heights.data());
  return heights;
}

}  // namespace

TEST_CASE("surface: an array comes back where it lay") {
  const TemporaryFolder folder;
  const Surface surface = Surface::from_file(stream_file(folder, {}));
  const SurfaceInfo& info = surface.info();
  CHECK(!info.is_pack);
  CHECK(info.box.west == 600000);
  CHECK(info.box.east == 600590);
  CHECK(info.box.north == 5000000);
  CHECK(info.box.south == 4999560);
  CHECK(info.source.columns == kBowlColumns);
  CHECK(info.source.rows == kBowlRows);
  CHECK(info.lowest == 2);
  CHECK(largest_error(raster_of(surface)) <= kRounding);
}

TEST_CASE("surface: a pack keeps its bound at posts, queried in any order" *
          microtin::tests::kSlow) {
  const TemporaryFolder folder;
  const Surface surface = Surface::from_file(pack_file(folder));
  CHECK(surface.info().is_pack);
  CHECK(surface.info().tile_columns == 4);
  CHECK(surface.info().tile_rows == 3);
  CHECK(largest_error(raster_of(surface)) <= 1 + kRounding);

  const std::vector<double> expected = raster_of(surface);
  std::vector<double> x, y, heights(expected.size());
  std::vector<size_t> at;
  for (size_t i = 0; i < expected.size(); ++i) {
    at.push_back(i * 1009 % expected.size());  // 1009 is a prime
    x.push_back(600000.0 + 10.0 * static_cast<double>(at.back() % kBowlColumns));
    const size_t row = at.back() / kBowlColumns;
    y.push_back(5000000.0 - 10.0 * static_cast<double>(row));
  }
  surface.heights(x.size(), x.data(), y.data(), heights.data());
  size_t differ = 0;
  for (size_t i = 0; i < at.size(); ++i) {
    const double post = expected[at[i]];
    differ += std::isnan(post) ? !std::isnan(heights[i]) : post != heights[i];
  }
  CHECK(differ == 0);
}

TEST_CASE("surface: heights are those of the exact plane, between places of the lattice, too") {
  // A slope of 1 in 10 across a single triangle's width, in a stream and in a pack's tiles.
  std::vector<double> slope(size_t{33} * 33);
  for (size_t i = 0; i < slope.size(); ++i) slope[i] = static_cast<double>(i % 33);
  const SourceTerrain terrain(raster_from_cells(33, 33, slope.data(), kTransform));
  const TemporaryFolder folder;
  write_file(folder / "slope.mtin", encode_stream(terrain, {}).bytes);
  Options options;
  options.max_error = "0";
  options.tile_vertices = 16;
  options.tile_size = 8;
  encode_pack(terrain, options, folder / "slope.mtp");
  for (const char* const name : {"slope.mtin", "slope.mtp"}) {
    const Surface surface = Surface::from_file(folder / name);
    std::vector<double> x, y;
    for (int i = 0; i < 3000; ++i) {
      x.push_back(600000 + i % 1000 * 0.31998);
      y.push_back(5000000 - i % 77 * 4.1);
    }
    std::vector<double> heights(x.size());
    surface.heights(x.size(), x.data(), y.data(), heights.data());
    double largest = 0;
    for (size_t i = 0; i < x.size(); ++i) {
      largest = std::max(largest, std::fabs(heights[i] - (x[i] - 600000) / 10));
    }
    CHECK(largest < 1e-13);
    const Grid grid{32001, 1, {60000000, 1, 100}, {5000000, 1, 1}};
    std::vector<double> row(grid.columns);
    surface.heights(grid, {0, 0, grid.columns, 1}, row.data());
    for (size_t i = 0; i < row.size(); ++i) {
      largest = std::max(largest, std::fabs(row[i] - static_cast<double>(i) / 1000));
    }
    CHECK(largest < 1e-13);
  }
}

TEST_CASE("surface: places outside and no numbers have no height") {
  const TemporaryFolder folder;
  const Surface surface = Surface::from_file(stream_file(folder, {}));
  const double none = std::nan(""), far = 1e300;
  const std::vector<double> x{599999, 600591, none, far, -far, 600000},
      y{4999700, 4999700, 4999700, 4999700, none, 5000001};
  std::vector<double> heights(x.size(), 0);
  surface.heights(x.size(), x.data(), y.data(), heights.data());
  for (const double height : heights) CHECK(std::isnan(height));
  const Grid& grid = surface.info().source;
  double corner[4] = {0, 0, 0, 0};
  surface.heights(grid, {-1, -1, 2, 2}, corner);  // the first post alone is within
  CHECK(std::isnan(corner[0]));
  CHECK(!std::isnan(corner[1]));
  CHECK(std::isnan(corner[2]));
  CHECK(std::isnan(corner[3]));
  CHECK_THROWS_WITH(surface.heights({1, 1, {0, 1, 0}, {0, 1, 1}}, {0, 0, 1, 1}, corner),
                    "an axis has no step");
}

TEST_CASE("surface: tiles together have the triangles of all" * microtin::tests::kSlow) {
  const TemporaryFolder folder;
  const Surface surface = Surface::from_file(pack_file(folder));
  const SurfaceInfo& info = surface.info();
  size_t triangles = 0, vertices = 0;
  for (uint32_t row = 0; row < info.tile_rows; ++row) {
    for (uint32_t column = 0; column < info.tile_columns; ++column) {
      const Mesh tile = surface.tile(column, row);
      const Box box = surface.tile_box(column, row);
      triangles += tile.triangles.size();
      vertices += tile.vertices.size();
      for (const auto& [x, y, z] : tile.vertices) {
        CHECK((x >= box.west && x <= box.east && y >= box.south && y <= box.north));
        CHECK((z >= info.lowest && z <= info.highest));
      }
    }
  }
  CHECK(vertices == info.vertices);
  CHECK(surface.mesh().triangles.size() == triangles);
  CHECK(surface.mesh().vertices.size() < vertices);
  CHECK_THROWS_AS(surface.tile(info.tile_columns, 0), std::out_of_range);
}

TEST_CASE("surface: cells of another size") {
  const TemporaryFolder folder;
  const Surface surface = Surface::from_file(stream_file(folder, {}));
  const Grid grid = surface.grid("2.5");
  CHECK(grid.columns == 59 * 4 + 1);
  CHECK(grid.rows == 44 * 4 + 1);
  CHECK(coordinate(grid.x, 0) == 600000);
  CHECK(coordinate(grid.x, 4) == 600010);
  CHECK_THROWS_WITH(surface.grid("0"), "cell: 0 is not a length above 0");
  CHECK_THROWS(surface.grid("0.0000001"));
}

TEST_CASE("surface: bytes of any file system, an error names the damaged file") {
  class HeldBytes : public microtin::encoder::ByteSource {
   public:
    explicit HeldBytes(std::vector<uint8_t> bytes) : bytes_(std::move(bytes)) {}
    uint64_t size() const override { return bytes_.size(); }
    size_t read(uint64_t offset, void* to, size_t size) const override {
      if (offset >= bytes_.size()) return 0;
      const size_t taken = std::min<size_t>(size, bytes_.size() - offset);
      std::memcpy(to, bytes_.data() + offset, taken);
      return taken;
    }

   private:
    std::vector<uint8_t> bytes_;
  };
  std::vector<uint8_t> bytes = encode_stream(bowl_terrain(), {}).bytes;
  const auto open = [&] { return Surface::from_bytes(std::make_unique<HeldBytes>(bytes), "held"); };
  CHECK(largest_error(raster_of(open())) <= kRounding);
  bytes[bytes.size() / 2] ^= 1;
  CHECK_THROWS_WITH(open(), "held: damaged: a checksum does not match");
  bytes.clear();
  CHECK_THROWS_WITH(open(), "held: cut off: the stream ends too early");
}

TEST_CASE("binary numbers: what is refused, and where") {
  std::vector<double> heights = bowl();
  const auto posts = [&](const Transform& t) {
    return raster_from_cells(kBowlColumns, kBowlRows, heights.data(), t);
  };
  CHECK(posts(kTransform).decimals == 1);
  CHECK(posts({0, 1, 1e-18, 0, -1e-9, -1}).x.offset == posts({0, 1, 0, 0, 0, -1}).x.offset);
  CHECK_THROWS(posts({0, 1, 2e-9, 0, 0, -1}));
  CHECK_THROWS(posts({0, 1000, 0, 0, -2e-9, -1}));
  CHECK_THROWS(posts({0, 1, std::nan(""), 0, 0, -1}));
  CHECK_THROWS_WITH(posts({0, 1, 0.5, 0, 0, -1}),
                    "transform: columns must run east and rows north or south: WEST, WIDTH, 0, "
                    "NORTH, 0, -HEIGHT, GDAL's order");
  CHECK_THROWS_WITH(posts({10, 0, 400000, 0, -10, 5000000}), doctest::Contains("GDAL's order"));
  CHECK_THROWS(posts({0, -1, 0, 0, 0, -1}));
  CHECK_THROWS_WITH(posts({0, 1, 0, 0, 0, 0}),
                    "transform: cells have no extent; give them a width and a height above 0");
  CHECK_THROWS_WITH(posts({std::nan(""), 1, 0, 0, 0, -1}), "transform: a number is out of range");
  heights[kBowlColumns + 7] = 1e300;
  CHECK_THROWS_WITH(
      posts(kTransform),
      doctest::Contains(
          "row 1, column 7: 1.0000000000000001e+300 is not a height in range: if it marks voids"));
  const double points[] = {0, 0, 1.5, 10, 0, 2, 0, 10.25, INFINITY};
  CHECK(point_cloud_from_xyz(2, points).z_decimals == 1);
  CHECK_THROWS_WITH(point_cloud_from_xyz(3, points), "point 2: is not a number in range");
}

TEST_CASE(
    "binary numbers: floats stand for their shortest decimals, southern rows may come first") {
  const float heights[] = {0.1F, 0.2F, 0.3F, 1.25F};
  const RasterData north = raster_from_cells(2, 2, heights, {0, 1, 0, 2, 0, -1});
  CHECK(north.decimals == 2);
  CHECK(north.heights == std::vector<int64_t>{30, 125, 10, 20});
  const RasterData south = raster_from_cells(2, 2, heights, {0, 1, 0, 0, 0, 1});
  CHECK(south.heights == std::vector<int64_t>{10, 20, 30, 125});
  CHECK(coordinate(south.y, 0) == coordinate(north.y, 0));
}

TEST_CASE("C: an array of more posts than there can be is short of memory, no fault") {
  const double height = 0;
  microtin_raster_data raster = {};
  raster.size = sizeof raster;
  raster.columns = raster.rows = UINT32_MAX;
  raster.heights = &height;
  std::copy(kTransform.begin(), kTransform.end(), raster.transform);
  microtin_source* terrain = nullptr;
  CHECK(microtin_source_from_raster(&raster, &terrain) == MICROTIN_STATUS_NO_MEMORY);
  CHECK(terrain == nullptr);
}

TEST_CASE("C: an array goes to a stream and back" * microtin::tests::kSlow) {
  const std::vector<double> heights = bowl();
  microtin_raster_data raster = {};
  raster.size = sizeof raster;
  raster.columns = kBowlColumns;
  raster.rows = kBowlRows;
  raster.heights = heights.data();
  std::copy(kTransform.begin(), kTransform.end(), raster.transform);
  microtin_source* terrain = nullptr;
  REQUIRE(microtin_source_from_raster(&raster, &terrain) == MICROTIN_STATUS_OK);

  microtin_options options = {};
  uint8_t* bytes = nullptr;
  uint64_t size = 0;
  microtin_report report{};
  report.size = sizeof report;
  CHECK(microtin_encode_stream(terrain, &options, &bytes, &size, &report) ==
        MICROTIN_STATUS_REJECTED);
  CHECK(microtin_last_error() == std::string("the size of a struct is not set: assign its sizeof"));
  options.size = sizeof options;
  options.max_error = "0.5";
  options.effort = MICROTIN_EFFORT_FAST;
  REQUIRE(microtin_encode_stream(terrain, &options, &bytes, &size, &report) == MICROTIN_STATUS_OK);
  CHECK(report.bytes == size);
  CHECK(std::strtod(report.max_error, nullptr) <= 0.5);

  options.depths = 1;
  uint8_t* turned = nullptr;
  REQUIRE(microtin_encode_stream(terrain, &options, &turned, &size, nullptr) == MICROTIN_STATUS_OK);
  CHECK(std::strstr(microtin_last_warnings(), "depths are turned into heights") != nullptr);
  microtin_surface* upside_down = nullptr;
  REQUIRE(microtin_surface_from_bytes(turned, size, "turned", &upside_down) == MICROTIN_STATUS_OK);
  microtin_surface_info below{};
  below.size = sizeof below;
  microtin_surface_get_info(upside_down, &below);
  CHECK(below.lowest < -100);
  CHECK(below.highest <= 0.5);
  microtin_surface_free(upside_down);
  microtin_bytes_free(turned);
  options.depths = 0;

  options.progress = [](void*, double) { return 1; };
  uint8_t* none = nullptr;
  CHECK(microtin_encode_stream(terrain, &options, &none, &size, nullptr) ==
        MICROTIN_STATUS_CANCELLED);
  CHECK(none == nullptr);
  microtin_source_free(terrain);

  microtin_surface* surface = nullptr;
  REQUIRE(microtin_surface_from_bytes(bytes, report.bytes, "bowl", &surface) == MICROTIN_STATUS_OK);
  microtin_surface_info info{};
  info.size = sizeof info;
  microtin_surface_get_info(surface, &info);
  CHECK(info.bound == std::string("0.5"));
  microtin_grid grid{};
  grid.size = sizeof grid;
  REQUIRE(microtin_surface_grid(surface, nullptr, &grid) == MICROTIN_STATUS_OK);
  std::vector<double> back(size_t{grid.columns} * grid.rows);
  REQUIRE(microtin_surface_sample_grid(surface, &grid, back.data()) == MICROTIN_STATUS_OK);
  CHECK(largest_error(back) <= 0.5 + kRounding);
  microtin_triangles triangles{};
  triangles.size = sizeof triangles;
  REQUIRE(microtin_surface_mesh(surface, &triangles) == MICROTIN_STATUS_OK);
  CHECK(triangles.vertices == report.vertices);
  CHECK(triangles.corners[3 * triangles.triangles - 1] < triangles.vertices);
  CHECK(microtin_surface_tile(surface, 1, 0, &triangles) == MICROTIN_STATUS_REJECTED);
  double height = 0;
  CHECK(microtin_surface_mesh(nullptr, &triangles) == MICROTIN_STATUS_REJECTED);
  CHECK(microtin_surface_heights(nullptr, 1, &height, &height, &height) ==
        MICROTIN_STATUS_REJECTED);
  CHECK(microtin_surface_heights(surface, 1, &height, &height, nullptr) ==
        MICROTIN_STATUS_REJECTED);
  CHECK(microtin_surface_heights(surface, 0, nullptr, nullptr, nullptr) == MICROTIN_STATUS_OK);
  CHECK(microtin_surface_gradients(surface, 1, &height, &height, &height, nullptr) ==
        MICROTIN_STATUS_REJECTED);
  CHECK(microtin_surface_gradients(surface, 0, nullptr, nullptr, nullptr, nullptr) ==
        MICROTIN_STATUS_OK);
  microtin_surface_free(surface);
  microtin_bytes_free(bytes);
  CHECK(microtin_surface_from_file("/nowhere/a.mtin", &surface) == MICROTIN_STATUS_REJECTED);
  CHECK(std::strstr(microtin_last_error(), "/nowhere/a.mtin") != nullptr);
}
