// SPDX-License-Identifier: MIT
// The public face in C against that in C++: each member of its structs, each function.
#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "microtin/encoder.h"
#include "microtin/encoder.hpp"
#include "microtin/surface.hpp"
#include "tests/support/device.hpp"
#include "tests/support/files.hpp"
#include "tests/support/members.hpp"
#include "tests/support/temporary_folder.hpp"

namespace microtin::tests {
namespace {

namespace library = microtin::encoder;

constexpr const char* kC = "encoder/include/microtin/encoder.h";
constexpr const char* kSystem = "LOCAL_CS[\"site\",UNIT[\"Foot\",0.3048]]";

// 12 columns and 7 rows, the first height void.
std::vector<double> heights() {
  std::vector<double> all(84);
  for (int i = 0; i < 84; ++i) all[static_cast<size_t>(i)] = 0.5 * (i * i % 37) - 3;
  all[0] = std::numeric_limits<double>::quiet_NaN();
  return all;
}

struct InC {
  microtin_raster_data raster{};
  std::vector<double> doubles = heights();
  std::vector<float> floats{doubles.begin(), doubles.end()};

  InC() {
    raster.size = sizeof raster;
    raster.columns = 12;
    raster.rows = 7;
    raster.heights = doubles.data();
    const double usual[] = {-0.5, 1, 0, 6.5, 0, -1};
    std::copy(std::begin(usual), std::end(usual), raster.transform);
  }
  InC(const InC&) = delete;
  InC& operator=(const InC&) = delete;
};

template <class Content>
Bytes encoded(const Content& content, microtin_status (*make)(const Content*, microtin_source**)) {
  microtin_source* terrain = nullptr;
  REQUIRE(make(&content, &terrain) == MICROTIN_STATUS_OK);
  microtin_options options{};
  options.size = sizeof options;
  uint8_t* bytes = nullptr;
  uint64_t size = 0;
  REQUIRE(microtin_encode_stream(terrain, &options, &bytes, &size, nullptr) == MICROTIN_STATUS_OK);
  Bytes stream(bytes, bytes + size);
  microtin_bytes_free(bytes);
  microtin_source_free(terrain);
  return stream;
}

struct RasterRow {
  std::string member;
  std::function<void(InC&)> change;
};

const std::vector<RasterRow> kRasterRows = {
    {"columns", [](InC& c) { c.raster.columns = 6; }},
    {"rows", [](InC& c) { c.raster.rows = 5; }},
    {"heights", [](InC& c) { c.doubles[13] += 1; }},
    {"wkt", [](InC& c) { c.raster.wkt = kSystem; }},
    {"transform", [](InC& c) { c.raster.transform[0] += 2; }},
    {"transform", [](InC& c) { c.raster.transform[1] = 2; }},
    {"transform", [](InC& c) { c.raster.transform[3] += 2; }},
    {"transform", [](InC& c) { c.raster.transform[5] = -2; }},
    {"transform", [](InC& c) { c.raster.transform[5] = 1; }},
    {"no_data",
     [](InC& c) {
       static const double value = -3;
       c.raster.no_data = &value;
     }},
    {"float_heights",
     [](InC& c) {
       c.raster.heights = nullptr;
       c.floats[13] += 1;
       c.raster.float_heights = c.floats.data();
     }},
};

Bytes stream_in_cpp(const InC& c) {
  library::Transform transform{};
  std::copy(std::begin(c.raster.transform), std::end(c.raster.transform), transform.begin());
  const microtin_raster_data& r = c.raster;
  const double no_data = r.no_data != nullptr ? *r.no_data : library::kNoValue;
  library::RasterData posts =
      r.heights != nullptr
          ? library::raster_from_cells(r.columns, r.rows, r.heights, transform, no_data)
          : library::raster_from_cells(r.columns, r.rows, r.float_heights, transform, no_data);
  if (c.raster.wkt != nullptr) posts.wkt = c.raster.wkt;
  return encode_stream(library::SourceTerrain(std::move(posts)), {}).bytes;
}

const std::vector<double> kPoints = {0, 0, 1, 9, 0, 2.5, 0, 9, 3, 9, 9, 4, 4, 5, 9, 2, 3, 1};

microtin_point_data points_in_c() {
  return {sizeof(microtin_point_data), kPoints.size() / 3, kPoints.data(), nullptr};
}

Bytes points_in_cpp(uint64_t count, const double* coordinates, const std::string& wkt) {
  library::PointCloudData points = library::point_cloud_from_xyz(count, coordinates);
  points.wkt = wkt;
  return encode_stream(library::SourceTerrain(points), {}).bytes;
}

// A surface in both languages.
class Both {
 public:
  explicit Both(const std::string& path) : cpp(library::Surface::from_file(path)) {
    REQUIRE(microtin_surface_from_file(path.c_str(), &c) == MICROTIN_STATUS_OK);
  }
  ~Both() { microtin_surface_free(c); }
  Both(const Both&) = delete;
  Both& operator=(const Both&) = delete;

  library::Surface cpp;
  microtin_surface* c = nullptr;
};

void expect_same(const library::Mesh& mesh, const microtin_triangles& triangles) {
  REQUIRE(triangles.vertices == mesh.vertices.size());
  REQUIRE(triangles.triangles == mesh.triangles.size());
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) CHECK(triangles.coordinates[3 * i + k] == mesh.vertices[i][k]);
  }
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) CHECK(triangles.corners[3 * i + k] == mesh.triangles[i][k]);
  }
}

bool is_same(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), 8 * a.size()) == 0;
}

void expect_same_raster(const Both& both, const char* cell) {
  const library::Grid grid = both.cpp.grid(cell);
  microtin_grid in_c{};
  in_c.size = sizeof in_c;
  REQUIRE(microtin_surface_grid(both.c, cell, &in_c) == MICROTIN_STATUS_OK);
  CHECK(in_c.columns == grid.columns);
  CHECK(in_c.rows == grid.rows);
  for (const auto& [a, b] : {std::pair(in_c.x, grid.x), std::pair(in_c.y, grid.y)}) {
    CHECK(std::tuple(a.offset, a.numerator, a.denominator) ==
          std::tuple(b.offset, b.numerator, b.denominator));
  }
  std::vector<double> expected(size_t{grid.columns} * grid.rows), found(expected.size());
  both.cpp.heights(grid, {0, 0, grid.columns, grid.rows}, expected.data());
  REQUIRE(microtin_surface_sample_grid(both.c, &in_c, found.data()) == MICROTIN_STATUS_OK);
  CHECK(is_same(expected, found));
}

void expect_same_heights(const Both& both) {
  std::vector<double> x, y;
  for (int i = 0; i < 300; ++i) {
    x.push_back(i * 7 % 130 / 10.0 - 0.5);
    y.push_back(i * 11 % 80 / 10.0 - 0.5);
  }
  std::vector<double> expected(x.size()), found(x.size());
  both.cpp.heights(x.size(), x.data(), y.data(), expected.data());
  REQUIRE(microtin_surface_heights(both.c, x.size(), x.data(), y.data(), found.data()) ==
          MICROTIN_STATUS_OK);
  CHECK(is_same(expected, found));
  std::vector<double> expected_north(x.size()), north(x.size());
  both.cpp.gradients(x.size(), x.data(), y.data(), expected.data(), expected_north.data());
  REQUIRE(microtin_surface_gradients(both.c, x.size(), x.data(), y.data(), found.data(),
                                     north.data()) == MICROTIN_STATUS_OK);
  CHECK(is_same(expected, found));
  CHECK(is_same(expected_north, north));
}

}  // namespace

TEST_CASE("C: each member of a raster makes the difference that it makes in C++") {
  const Bytes usual = encoded(InC().raster, microtin_source_from_raster);
  CHECK(usual == stream_in_cpp(InC()));
  Names known = {"size"};
  for (const RasterRow& row : kRasterRows) {
    CAPTURE(row.member);
    known.insert(row.member);
    InC changed;
    row.change(changed);
    const Bytes stream = encoded(changed.raster, microtin_source_from_raster);
    CHECK(stream != usual);
    CHECK(stream == stream_in_cpp(changed));
  }
  CHECK(text_of(members_of(kC, "microtin_raster_data")) == text_of(known));
}

TEST_CASE("C: each member of points makes the difference that it makes in C++") {
  const Bytes usual = encoded(points_in_c(), microtin_source_from_points);
  CHECK(usual == points_in_cpp(6, kPoints.data(), ""));
  microtin_point_data fewer = points_in_c(), others = points_in_c(), placed = points_in_c();
  fewer.count = 5;
  others.coordinates += 3;
  others.count = 5;
  placed.wkt = kSystem;
  CHECK(encoded(fewer, microtin_source_from_points) == points_in_cpp(5, kPoints.data(), ""));
  CHECK(encoded(others, microtin_source_from_points) == points_in_cpp(5, kPoints.data() + 3, ""));
  CHECK(encoded(placed, microtin_source_from_points) == points_in_cpp(6, kPoints.data(), kSystem));
  CHECK(encoded(placed, microtin_source_from_points) != usual);
  CHECK(text_of(members_of(kC, "microtin_point_data")) == "coordinates count size wkt ");
}

namespace {

void expect_same_margins(const Both& both, uint32_t column, uint32_t row) {
  microtin_tile_margins margins{};
  margins.size = sizeof margins;
  REQUIRE(microtin_surface_tile_margins(both.c, column, row, &margins) == MICROTIN_STATUS_OK);
  const library::TileMargins found = both.cpp.tile_margins(column, row);
  CHECK(margins.max_below_everywhere == found.max_below_everywhere);
  CHECK(margins.max_above_everywhere == found.max_above_everywhere);
  CHECK(!found.max_below_everywhere.empty());
}

bool is_same_number(double a, double b) {
  return std::isnan(a) ? std::isnan(b) : a == b;
}

void expect_same_bounds(const library::HeightBounds& cpp, const microtin_height_bounds& c) {
  CHECK(is_same_number(cpp.lowest, c.lowest));
  CHECK(is_same_number(cpp.highest, c.highest));
  CHECK(is_same_number(cpp.source_lowest, c.source_lowest));
  CHECK(is_same_number(cpp.source_highest, c.source_highest));
  CHECK(cpp.is_complete == (c.is_complete != 0));
}

void expect_same_bounds(const Both& both) {
  microtin_height_bounds bounds{};
  bounds.size = sizeof bounds;
  for (const double reach : {0.5, 3.0, 90.0}) {
    CHECK(microtin_surface_bounds_in_box(both.c, 1, 2, 1 + reach, 2 + reach, &bounds) ==
          MICROTIN_STATUS_OK);
    expect_same_bounds(both.cpp.bounds_in_box({1, 2, 1 + reach, 2 + reach}), bounds);
    CHECK(microtin_surface_bounds_on_line(both.c, 1, 2, 1 + reach, 2, &bounds) ==
          MICROTIN_STATUS_OK);
    expect_same_bounds(both.cpp.bounds_on_line({1, 2}, {1 + reach, 2}), bounds);
  }
  CHECK(microtin_surface_bounds_in_box(both.c, NAN, 2, 1, 2, &bounds) == MICROTIN_STATUS_REJECTED);
  CHECK(microtin_surface_bounds_on_line(both.c, 1, 2, 1, 2, nullptr) == MICROTIN_STATUS_REJECTED);
}

void expect_same_profile(const library::Profile& cpp, const microtin_profile& c) {
  REQUIRE(c.count == cpp.places.size());
  CHECK(c.length == cpp.length);
  CHECK(c.earth_radius == cpp.earth_radius);
  CHECK(is_same_number(c.geodesic_deviation, cpp.geodesic_deviation));
  CHECK(c.result == static_cast<uint32_t>(cpp.result));
  for (size_t i = 0; i < c.count; ++i) {
    const library::ProfilePlace& p = cpp.places[i];
    const double expected[] = {p.along, p.distance, p.x, p.y, p.height, p.below, p.above};
    for (size_t k = 0; k < 7; ++k) CHECK(is_same_number(c.places[7 * i + k], expected[k]));
    CHECK((c.is_known_before[i] != 0) == p.is_known_before);
  }
}

// Compares lines inside, across the rim, and of no length, by each option.
void expect_same_profiles(const Both& both) {
  const double ends[] = {1, 2, 3, 10, 5, 4, -3, 1, 9, 8, 4, 1, 4, 4, 1, 4, 4, 2};
  constexpr size_t kLines = 3;
  microtin_sight_options usual{};
  usual.size = sizeof usual;
  microtin_sight_options flat = usual, radio = usual, datum = usual, safe = usual;
  flat.earth_factor = 1e-3;  // a small ball
  radio.frequency = 2400;
  radio.zone_share = 0.1;
  datum.from_datum = 1;
  datum.to_datum = 1;
  safe.is_safe = 1;
  for (const microtin_sight_options& given : {usual, flat, radio, datum, safe}) {
    uint8_t line[kLines], zone[kLines];
    double numbers[6][kLines];
    const microtin_sights to = {sizeof to,  line,       zone,       numbers[0], numbers[1],
                                numbers[2], numbers[3], numbers[4], numbers[5]};
    REQUIRE(microtin_surface_lines_of_sight(both.c, kLines, ends, &given, &to) ==
            MICROTIN_STATUS_OK);
    library::SightOptions options;
    if (given.earth_factor != 0) options.earth_factor = given.earth_factor;
    if (given.zone_share != 0) options.zone_share = given.zone_share;
    options.frequency = given.frequency;
    options.is_safe = given.is_safe != 0;
    for (size_t i = 0; i < kLines; ++i) {
      const double* const e = ends + 6 * i;
      const library::Profile profile = both.cpp.profile({e[0], e[1]}, {e[3], e[4]});
      microtin_profile c{};
      c.size = sizeof c;
      REQUIRE(microtin_surface_profile(both.c, e[0], e[1], e[3], e[4], &c) == MICROTIN_STATUS_OK);
      expect_same_profile(profile, c);
      const library::LineOfSight sight = line_of_sight(profile, {e[2], given.from_datum != 0},
                                                       {e[5], given.to_datum != 0}, options);
      CHECK(line[i] == static_cast<uint8_t>(sight.line));
      CHECK(zone[i] == static_cast<uint8_t>(sight.zone));
      const double expected[] = {sight.least_clearance,   sight.least_clearance_at,
                                 sight.first_obstruction, sight.first_zone_obstruction,
                                 sight.free_share,        sight.free_share_at};
      for (size_t k = 0; k < 6; ++k) CHECK(is_same_number(numbers[k][i], expected[k]));
    }
  }
  microtin_sights nothing{};
  nothing.size = sizeof nothing;
  CHECK(microtin_surface_lines_of_sight(both.c, 3, ends, nullptr, &nothing) == MICROTIN_STATUS_OK);
  CHECK(microtin_surface_lines_of_sight(both.c, 1, nullptr, nullptr, &nothing) ==
        MICROTIN_STATUS_REJECTED);
  flat.earth_factor = -1;
  CHECK(microtin_surface_lines_of_sight(both.c, 1, ends, &flat, &nothing) ==
        MICROTIN_STATUS_REJECTED);
}

}  // namespace

TEST_CASE("C: what a surface hands out is that of C++, of streams and packs") {
  const TemporaryFolder folder;
  InC c;
  write_file(folder / "a.mtin", encoded(c.raster, microtin_source_from_raster));
  library::Options options;
  options.tile_vertices = 30;
  library::Transform transform{-0.5, 1, 0, 6.5, 0, -1};
  encode_pack(
      library::SourceTerrain(library::raster_from_cells(12, 7, c.doubles.data(), transform)),
      options, folder / "a.mtp");
  for (const char* name : {"a.mtin", "a.mtp"}) {
    CAPTURE(name);
    Both both(folder / name);
    microtin_triangles triangles{};
    triangles.size = sizeof triangles;
    REQUIRE(microtin_surface_mesh(both.c, &triangles) == MICROTIN_STATUS_OK);
    expect_same(both.cpp.mesh(), triangles);
    const library::SurfaceInfo& info = both.cpp.info();
    CHECK((info.tile_columns * info.tile_rows > 1) == info.is_pack);
    for (uint32_t row = 0; row < info.tile_rows; ++row) {
      for (uint32_t column = 0; column < info.tile_columns; ++column) {
        REQUIRE(microtin_surface_tile(both.c, column, row, &triangles) == MICROTIN_STATUS_OK);
        expect_same(both.cpp.tile(column, row), triangles);
        expect_same_margins(both, column, row);
      }
    }
    microtin_tile_margins margins{};
    margins.size = sizeof margins;
    CHECK(microtin_surface_tile_margins(both.c, info.tile_columns, 0, &margins) ==
          MICROTIN_STATUS_REJECTED);
    CHECK(microtin_surface_tile_margins(both.c, 0, info.tile_rows, &margins) ==
          MICROTIN_STATUS_REJECTED);
    CHECK(microtin_surface_tile(both.c, info.tile_columns, 0, &triangles) ==
          MICROTIN_STATUS_REJECTED);
    CHECK(microtin_surface_tile(both.c, 0, info.tile_rows, &triangles) == MICROTIN_STATUS_REJECTED);
    expect_same_raster(both, "0.5");
    expect_same_heights(both);
    expect_same_profiles(both);
    expect_same_bounds(both);
    microtin_lines lines{};
    lines.size = sizeof lines;
    REQUIRE(microtin_surface_lines(both.c, &lines) == MICROTIN_STATUS_OK);
    CHECK(lines.count == 0);
  }
  CHECK(text_of(members_of(kC, "microtin_triangles")) ==
        "coordinates corners size triangles vertices ");
  CHECK(text_of(members_of(kC, "microtin_lines")) == "classes coordinates count size vertices ");
  CHECK(text_of(members_of(kC, "microtin_grid")) == "columns rows size x y ");
  CHECK(text_of(members_of(kC, "microtin_profile")) ==
        "count earth_radius geodesic_deviation is_known_before length places result size ");
  CHECK(text_of(members_of(kC, "microtin_sight_options")) ==
        "earth_factor frequency from_datum is_safe size to_datum zone_share ");
  CHECK(text_of(members_of(kC, "microtin_sights")) ==
        "first_obstruction first_zone_obstruction free_share free_share_at least_clearance "
        "least_clearance_at line size zone ");
  CHECK(text_of(members_of(kC, "microtin_height_bounds")) ==
        "highest is_complete lowest size source_highest source_lowest ");
  CHECK(text_of(members_of(kC, "microtin_tile_margins")) ==
        "max_above_everywhere max_below_everywhere size ");
}

TEST_CASE("C: bytes in memory are the surface that their file is, to the last of them") {
  const Bytes stream = encoded(InC().raster, microtin_source_from_raster);
  microtin_surface* surface = nullptr;
  REQUIRE(microtin_surface_from_bytes(stream.data(), stream.size(), "here", &surface) ==
          MICROTIN_STATUS_OK);
  microtin_surface_info info{};
  info.size = sizeof info;
  CHECK(microtin_surface_get_info(surface, &info) == MICROTIN_STATUS_OK);
  CHECK(info.bytes == stream.size());
  microtin_surface_free(surface);
  CHECK(microtin_surface_from_bytes(stream.data(), stream.size() - 1, "here", &surface) ==
        MICROTIN_STATUS_REJECTED);
  CHECK(std::string(microtin_last_error()).find("here: ") == 0);
}

namespace {

// A struct of a later version: the members that the library knows, and more.
template <class Struct>
struct Later {
  Struct known{};
  uint64_t more = 0;
  Later() { known.size = sizeof *this; }
};

microtin_status encode(const microtin_source* source, const microtin_options* options) {
  uint8_t* bytes = nullptr;
  uint64_t size = 0;
  const microtin_status status = microtin_encode_stream(source, options, &bytes, &size, nullptr);
  microtin_bytes_free(bytes);
  return status;
}

}  // namespace

TEST_CASE("C: a struct whose size is not set is refused, whichever it is") {
  InC c;
  microtin_source* source = nullptr;
  REQUIRE(microtin_source_from_raster(&c.raster, &source) == MICROTIN_STATUS_OK);
  const Bytes stream = encoded(c.raster, microtin_source_from_raster);
  microtin_surface* surface = nullptr;
  REQUIRE(microtin_surface_from_bytes(stream.data(), stream.size(), "here", &surface) ==
          MICROTIN_STATUS_OK);
  microtin_point_data points = points_in_c();
  for (const size_t size : {size_t{0}, sizeof(size_t) - 1, size_t{4097}, SIZE_MAX}) {
    CAPTURE(size);
    microtin_options options{}, complete{};
    complete.size = sizeof complete;
    microtin_report report{};
    microtin_surface_info info{};
    microtin_grid grid{};
    microtin_triangles triangles{};
    c.raster.size = points.size = options.size = report.size = size;
    microtin_tile_margins margins{};
    microtin_profile profile{};
    microtin_sights sights{};
    microtin_lines lines{};
    lines.size = size;
    info.size = grid.size = triangles.size = margins.size = profile.size = sights.size = size;
    uint8_t* bytes = nullptr;
    uint64_t count = 0;
    microtin_source* none = nullptr;
    double heights[84];
    for (const microtin_status status :
         {microtin_source_from_raster(&c.raster, &none),
          microtin_source_from_points(&points, &none), encode(source, &options),
          microtin_encode_pack(source, &options, "/nowhere/a.mtp", nullptr),
          microtin_encode_stream(source, &complete, &bytes, &count, &report),
          microtin_encode_pack(source, &complete, "/nowhere/a.mtp", &report),
          microtin_surface_get_info(surface, &info), microtin_surface_grid(surface, "1", &grid),
          microtin_surface_sample_grid(surface, &grid, heights),
          microtin_surface_mesh(surface, &triangles),
          microtin_surface_tile(surface, 0, 0, &triangles),
          microtin_surface_tile_margins(surface, 0, 0, &margins),
          microtin_surface_lines(surface, &lines),
          microtin_surface_profile(surface, 0, 0, 1, 1, &profile),
          microtin_surface_lines_of_sight(surface, 0, nullptr, nullptr, &sights)}) {
      CHECK(status == MICROTIN_STATUS_REJECTED);
      CHECK(microtin_last_error() ==
            std::string("the size of a struct is not set: assign its sizeof"));
    }
    CHECK(bytes == nullptr);
  }
  microtin_surface_free(surface);
  microtin_source_free(source);
}

TEST_CASE("C: a program of an earlier version passes smaller structs") {
  InC c;
  c.raster.size = offsetof(microtin_raster_data, no_data);
  const double ignored = -3;
  c.raster.no_data = &ignored;
  CHECK(encoded(c.raster, microtin_source_from_raster) == stream_in_cpp(InC()));
  microtin_surface* surface = nullptr;
  const Bytes stream = encoded(InC().raster, microtin_source_from_raster);
  REQUIRE(microtin_surface_from_bytes(stream.data(), stream.size(), "here", &surface) ==
          MICROTIN_STATUS_OK);
  microtin_surface_info info{};
  info.size = offsetof(microtin_surface_info, is_pack);
  info.is_pack = 77;
  REQUIRE(microtin_surface_get_info(surface, &info) == MICROTIN_STATUS_OK);
  CHECK(info.vertices == 83);
  CHECK(info.is_pack == 77);
  CHECK(info.size == offsetof(microtin_surface_info, is_pack));
  microtin_surface_free(surface);
}

TEST_CASE("C: larger structs of a later version are taken, and their unknown members refused") {
  InC c;
  microtin_source* source = nullptr;
  REQUIRE(microtin_source_from_raster(&c.raster, &source) == MICROTIN_STATUS_OK);
  Later<microtin_options> options;
  Later<microtin_report> report;
  report.more = 77;
  uint8_t* bytes = nullptr;
  uint64_t count = 0;
  REQUIRE(microtin_encode_stream(source, &options.known, &bytes, &count, &report.known) ==
          MICROTIN_STATUS_OK);
  CHECK(report.known.bytes == count);
  CHECK(report.more == 0);
  microtin_bytes_free(bytes);
  options.more = 1;
  CHECK(encode(source, &options.known) == MICROTIN_STATUS_REJECTED);
  CHECK(microtin_last_error() == std::string("a struct has members of a later version: link that "
                                             "version of libmicrotin"));
  microtin_source_free(source);
}

TEST_CASE("C: progress is heard by streams and packs of posts, and ends their work") {
  const TemporaryFolder folder;
  struct Heard {
    int calls = 0;
    double last = 0;
    int answer = 0;
  };
  InC c;
  microtin_source* terrain = nullptr;
  REQUIRE(microtin_source_from_raster(&c.raster, &terrain) == MICROTIN_STATUS_OK);
  for (const bool is_pack : {false, true}) {
    for (const int answer : {0, 1}) {
      Heard heard;
      heard.answer = answer;
      microtin_options options{};
      options.size = sizeof options;
      options.max_error = "2";
      options.tile_vertices = is_pack ? 30 : 0;
      options.context = &heard;
      options.progress = [](void* context, double done) {
        auto& told = *static_cast<Heard*>(context);
        CHECK((done >= told.last && done <= 1));
        told.last = done;
        ++told.calls;
        return told.answer;
      };
      uint8_t* bytes = nullptr;
      uint64_t size = 0;
      const microtin_status outcome =
          is_pack ? microtin_encode_pack(terrain, &options, (folder / "a.mtp").c_str(), nullptr)
                  : microtin_encode_stream(terrain, &options, &bytes, &size, nullptr);
      microtin_bytes_free(bytes);
      CHECK(outcome == (answer == 0 ? MICROTIN_STATUS_OK : MICROTIN_STATUS_CANCELLED));
      CHECK(heard.calls > 0);
    }
  }
  microtin_source_free(terrain);
}

}  // namespace microtin::tests
