// SPDX-License-Identifier: MIT
// Gradients of streams and packs in real units: those of the triangles of the surface's mesh.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "microtin/encoder.hpp"
#include "microtin/surface.hpp"
#include "tests/support/files.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace microtin::encoder;
using microtin::tests::TemporaryFolder;
using microtin::tests::write_file;

namespace {

constexpr uint32_t kSlopeSide = 40;
constexpr double kSlopeCell = 8, kSlopeLast = (kSlopeSide - 1) * kSlopeCell;
const double kNoSlope = std::nan("");

using RealSlope = std::pair<double, double>;

// Hills with a hole; row 0 is the northernmost.
RasterData sloping_hills(double west, double north, double cell) {
  std::vector<double> heights;
  for (uint32_t row = 0; row < kSlopeSide; ++row) {
    for (uint32_t column = 0; column < kSlopeSide; ++column) {
      const bool is_void = column > 18 && column < 25 && row > 10 && row < 20;
      heights.push_back(is_void ? kNoSlope
                                : static_cast<double>((7 * column * row + 3 * row) % 64) / 4);
    }
  }
  return raster_from_cells(kSlopeSide, kSlopeSide, heights.data(),
                           {west - cell / 2, cell, 0, north + cell / 2, 0, -cell});
}

Surface sloping_surface(const SourceTerrain& terrain, const TemporaryFolder& folder, bool is_pack) {
  Options options;
  options.max_error = "2";
  const std::string path = folder / (is_pack ? "t.mtp" : "t.mtin");
  if (is_pack) {
    options.tile_size = 16;
    options.tile_vertices = 400;
    encode_pack(terrain, options, path);
  } else {
    write_file(path, encode_stream(terrain, options).bytes);
  }
  return Surface::from_file(path);
}

RealSlope real_slope_at(const Surface& surface, double x, double y) {
  RealSlope slope;
  surface.gradients(1, &x, &y, &slope.first, &slope.second);
  return slope;
}

double twice_area(const std::array<double, 3>& a, const std::array<double, 3>& b, double x,
                  double y) {
  return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

// By definition, looking at every triangle; positions and vertices are multiples of 1/8.
std::optional<RealSlope> expected_slope_at(const Mesh& mesh, double x, double y) {
  std::optional<RealSlope> slope;
  std::array<double, 2> most{};
  for (const std::array<uint32_t, 3>& t : mesh.triangles) {
    const auto &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    if (twice_area(a, b, x, y) < 0 || twice_area(b, c, x, y) < 0 || twice_area(c, a, x, y) < 0)
      continue;
    const std::array<double, 2> centre = {a[0] + b[0] + c[0], a[1] + b[1] + c[1]};
    if (slope && centre < most) continue;
    most = centre;
    const double whole = twice_area(a, b, c[0], c[1]);
    slope = {((b[2] - a[2]) * (c[1] - a[1]) - (c[2] - a[2]) * (b[1] - a[1])) / whole,
             ((b[0] - a[0]) * (c[2] - a[2]) - (c[0] - a[0]) * (b[2] - a[2])) / whole};
  }
  return slope;
}

void check_slope_at(const Surface& surface, const Mesh& mesh, double x, double y, int& found) {
  CAPTURE(x);
  CAPTURE(y);
  const std::optional<RealSlope> expected = expected_slope_at(mesh, x, y);
  const RealSlope slope = real_slope_at(surface, x, y);
  REQUIRE(std::isnan(slope.first) == !expected);
  REQUIRE(std::isnan(slope.second) == !expected);
  if (!expected) return;
  ++found;
  REQUIRE(std::abs(slope.first - expected->first) <= 1e-12 * (1 + std::abs(expected->first)));
  REQUIRE(std::abs(slope.second - expected->second) <= 1e-12 * (1 + std::abs(expected->second)));
}

// How far the heights of a plane in degrees rise for a metre east and north.
RealSlope slope_of_plane(const std::string& units, double latitude) {
  const TemporaryFolder folder;
  const double cell = 0.001;
  std::vector<double> heights;
  for (uint32_t row = 0; row < 20; ++row) {
    for (uint32_t column = 0; column < 20; ++column) heights.push_back(5.0 * column - 3.0 * row);
  }
  Options options;
  options.units = units;
  const SourceTerrain terrain(
      raster_from_cells(20, 20, heights.data(), {7, cell, 0, latitude + 10 * cell, 0, -cell}));
  write_file(folder / "p.mtin", encode_stream(terrain, options).bytes);
  return real_slope_at(Surface::from_file(folder / "p.mtin"), 7.01, latitude);
}

}  // namespace

TEST_CASE("the gradient at a position is that of one triangle of the mesh, also on edges") {
  std::mt19937 random(1);
  const TemporaryFolder folder;
  for (const bool is_pack : {false, true}) {
    const Surface surface =
        sloping_surface(SourceTerrain(sloping_hills(0, kSlopeLast, kSlopeCell)), folder, is_pack);
    const Mesh mesh = surface.mesh();
    int found = 0, tried = 0;
    for (const auto& v : mesh.vertices) {
      check_slope_at(surface, mesh, v[0], v[1], found);
      ++tried;
    }
    for (int i = 0; i < 1500; ++i, ++tried) {
      const double unit = i % 2 == 0 ? kSlopeCell / 2 : 0.125;
      const auto pick = [&] {
        return std::floor(static_cast<double>(random() % 1100) / 1000 * kSlopeLast / unit) * unit;
      };
      const double x = pick();
      check_slope_at(surface, mesh, x, pick(), found);
    }
    CHECK(found > tried / 2);
    CHECK(found < tried);
  }
}

TEST_CASE("gradients of many positions are those of single ones, in any order") {
  const TemporaryFolder folder;
  const Surface surface =
      sloping_surface(SourceTerrain(sloping_hills(0, kSlopeLast, kSlopeCell)), folder, true);
  std::mt19937 random(2);
  std::vector<double> x, y;
  for (int i = 0; i < 300; ++i) {
    x.push_back(static_cast<double>(random() % 5000) / 5000 * kSlopeLast);
    y.push_back(static_cast<double>(random() % 5000) / 5000 * kSlopeLast);
  }
  std::vector<double> east(x.size()), north(x.size());
  surface.gradients(x.size(), x.data(), y.data(), east.data(), north.data());
  for (size_t i = 0; i < x.size(); ++i) {
    const RealSlope slope = real_slope_at(surface, x[i], y[i]);
    CHECK((slope.first == east[i] || std::isnan(slope.first)));
    CHECK((slope.second == north[i] || std::isnan(slope.second)));
    CHECK(std::isnan(slope.first) == std::isnan(east[i]));
  }
}

TEST_CASE("gradients are metres of rise for a metre, whatever the units") {
  constexpr double kRadian = 0.017453292519943295, kEquator = 6378137, kSquare = 0.0066943799901413;
  for (const double latitude : {0.0, 43.5, -70.0}) {
    CAPTURE(latitude);
    const double sine = std::sin(latitude * kRadian), root = std::sqrt(1 - kSquare * sine * sine);
    const double east = 0.001 * kRadian * std::cos(latitude * kRadian) * kEquator / root,
                 north = 0.001 * kRadian * kEquator * (1 - kSquare) / (root * root * root);
    const RealSlope metres = slope_of_plane("degree:metre", latitude);
    CHECK(metres.first == doctest::Approx(5 / east).epsilon(1e-5));
    CHECK(metres.second == doctest::Approx(3 / north).epsilon(1e-5));
    const RealSlope feet = slope_of_plane("degree:foot", latitude);
    CHECK(feet.first == doctest::Approx(0.3048 * metres.first).epsilon(1e-12));
  }
  const RealSlope same = slope_of_plane("metre:metre", 0), feet = slope_of_plane("foot:foot", 0);
  CHECK(same.first == doctest::Approx(5000).epsilon(1e-9));
  CHECK(same.second == doctest::Approx(3000).epsilon(1e-9));
  CHECK(feet.first == doctest::Approx(5000).epsilon(1e-9));
}
