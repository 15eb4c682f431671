// SPDX-License-Identifier: MIT
// Between which heights areas of streams and packs lie: by the vertices of the tiles they touch.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
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

constexpr uint32_t kBoundsSide = 65;
constexpr double kBoundsCell = 10, kBoundsLast = (kBoundsSide - 1) * kBoundsCell;
constexpr double kBoundsNear = kBoundsCell / 256;

// Hills; the last tiles of a pack are void. Row 0 is the northernmost.
SourceTerrain bounded_hills() {
  std::vector<double> heights;
  for (uint32_t row = 0; row < kBoundsSide; ++row) {
    for (uint32_t column = 0; column < kBoundsSide; ++column) {
      const bool is_void = column >= 48 && row >= 32;
      heights.push_back(is_void ? std::nan("")
                                : static_cast<double>((column * column + 31 * row) % 97));
    }
  }
  return SourceTerrain(raster_from_cells(
      kBoundsSide, kBoundsSide, heights.data(),
      {-kBoundsCell / 2, kBoundsCell, 0, kBoundsLast + kBoundsCell / 2, 0, -kBoundsCell}));
}

Surface bounded_pack(const TemporaryFolder& folder) {
  Options options;
  options.max_error = "1";
  options.tile_size = 16;
  options.tile_vertices = 400;
  encode_pack(bounded_hills(), options, folder / "t.mtp");
  return Surface::from_file(folder / "t.mtp");
}

// Whether the line comes within `reach` of a box, by many of its places; below 0: into the box.
bool line_meets(const Box& box, Surface::Position a, Surface::Position b, double reach) {
  constexpr int kPlaces = 20000;
  for (int i = 0; i <= kPlaces; ++i) {
    const double x = a.x + (b.x - a.x) * i / kPlaces, y = a.y + (b.y - a.y) * i / kPlaces;
    if (x >= box.west - reach && x <= box.east + reach && y >= box.south - reach &&
        y <= box.north + reach)
      return true;
  }
  return false;
}

struct HeightSpan {
  double lowest = 1e9, highest = -1e9;
  bool is_complete = true;

  void add(const Mesh& mesh) {
    if (mesh.vertices.empty()) is_complete = false;
    for (const auto& v : mesh.vertices) {
      lowest = std::min(lowest, v[2]);
      highest = std::max(highest, v[2]);
    }
  }
};

// The vertices of all tiles that meet(box) names.
template <class Meet>
HeightSpan height_span_of(const Surface& surface, const std::vector<Mesh>& tiles,
                          const Meet& meet) {
  HeightSpan span;
  for (uint32_t i = 0; i < tiles.size(); ++i) {
    const uint32_t columns = surface.info().tile_columns;
    if (meet(surface.tile_box(i % columns, i / columns))) span.add(tiles[i]);
  }
  return span;
}

std::vector<Mesh> meshes_of_tiles(const Surface& surface) {
  std::vector<Mesh> tiles;
  for (uint32_t row = 0; row < surface.info().tile_rows; ++row) {
    for (uint32_t column = 0; column < surface.info().tile_columns; ++column) {
      tiles.push_back(surface.tile(column, row));
    }
  }
  return tiles;
}

// The bounds hold what the area surely touches, and nothing but what it nearly touches.
void check_bounds_between(const HeightBounds& found, const HeightSpan& least,
                          const HeightSpan& most) {
  const bool has_terrain = !std::isnan(found.highest);
  if (least.highest >= least.lowest) REQUIRE(has_terrain);
  if (has_terrain) {
    REQUIRE(found.highest >= least.highest);
    REQUIRE(found.lowest <= least.lowest);
    REQUIRE(found.highest <= most.highest);
    REQUIRE(found.lowest >= most.lowest);
  }
  if (found.is_complete) REQUIRE(least.is_complete);
  if (most.is_complete && has_terrain) REQUIRE(found.is_complete);
}

}  // namespace

TEST_CASE("bounds of boxes and lines are those of the tiles that they touch, and cover the rest") {
  const TemporaryFolder folder;
  const Surface surface = bounded_pack(folder);
  const std::vector<Mesh> tiles = meshes_of_tiles(surface);
  std::mt19937 random(1);
  int complete = 0, partial = 0;
  for (int i = 0; i < 300; ++i) {
    const double unit = i % 3 == 0 ? 16 * kBoundsCell : i % 3 == 1 ? kBoundsCell : 1;
    const auto pick = [&] {
      return std::floor(static_cast<double>(random() % 10000) / 9999 * kBoundsLast / unit) * unit;
    };
    Surface::Position a, b;
    a.x = pick(), a.y = pick(), b.x = pick(), b.y = pick();
    if (i % 5 == 0) b.x = a.x;
    CAPTURE(i);
    const HeightBounds on_line = surface.bounds_on_line(a, b);
    const auto near = [&](double reach) {
      return height_span_of(surface, tiles,
                            [&](const Box& box) { return line_meets(box, a, b, reach); });
    };
    check_bounds_between(on_line, near(0), near(3 * kBoundsNear));
    const Box box = {std::min(a.x, b.x), std::min(a.y, b.y), std::max(a.x, b.x),
                     std::max(a.y, b.y)};
    const auto in_box = [&](double reach) {
      return height_span_of(surface, tiles, [&](const Box& tile) {
        return tile.west <= box.east + reach && tile.east >= box.west - reach &&
               tile.south <= box.north + reach && tile.north >= box.south - reach;
      });
    };
    const HeightBounds found = surface.bounds_in_box(box);
    check_bounds_between(found, in_box(0), in_box(2 * kBoundsNear));
    const Profile profile = surface.profile(a, b);
    for (const ProfilePlace& place : profile.places) {
      if (std::isnan(place.height)) continue;
      REQUIRE(place.height <= on_line.highest);
      REQUIRE(place.height >= on_line.lowest);
      REQUIRE(place.height <= found.highest);
    }
    REQUIRE(std::isnan(on_line.highest) == std::isnan(on_line.source_highest));
    if (!std::isnan(on_line.highest)) REQUIRE(on_line.source_highest >= on_line.highest);
    ++(on_line.is_complete ? complete : partial);
  }
  CHECK(complete > 50);
  CHECK(partial > 50);
}

TEST_CASE("bounds of areas that leave a surface are not complete, and a stream is one tile") {
  const TemporaryFolder folder;
  const Surface pack = bounded_pack(folder);
  CHECK(pack.bounds_in_box({0, 0, 100, 100}).is_complete);
  CHECK(!pack.bounds_in_box({-1, 0, 100, 100}).is_complete);
  CHECK(!pack.bounds_on_line({0, 0}, {0, kBoundsLast + 1}).is_complete);
  const HeightBounds outside = pack.bounds_in_box({-100, -100, -50, -50});
  CHECK(std::isnan(outside.highest));
  CHECK(!outside.is_complete);
  CHECK(std::isnan(pack.bounds_on_line({kBoundsLast + 9, 0}, {kBoundsLast + 99, 9}).lowest));
  CHECK_THROWS_AS(pack.bounds_in_box({std::nan(""), 0, 1, 1}), std::runtime_error);
  Options options;
  options.max_error = "1";
  write_file(folder / "t.mtin", encode_stream(bounded_hills(), options).bytes);
  const Surface stream = Surface::from_file(folder / "t.mtin");
  const HeightBounds all = stream.bounds_on_line({0, 0}, {10, 10});
  CHECK(all.highest == stream.info().highest);
  CHECK(all.lowest == stream.info().lowest);
  CHECK(all.is_complete);
  CHECK(all.source_highest == all.highest + std::stod(stream.info().max_below_everywhere));
}

TEST_CASE("bounds in degrees are found by any name of a longitude") {
  const TemporaryFolder folder;
  std::vector<double> heights(20 * 20, 5);
  heights[0] = 9;
  Options options;
  options.units = "degree:metre";
  const SourceTerrain terrain(
      raster_from_cells(20, 20, heights.data(), {179.9, 0.01, 0, 10, 0, -0.01}));
  write_file(folder / "d.mtin", encode_stream(terrain, options).bytes);
  const Surface surface = Surface::from_file(folder / "d.mtin");
  for (const double turn : {-360.0, 0.0, 360.0}) {
    const HeightBounds found = surface.bounds_in_box({179.95 + turn, 9.85, 180.05 + turn, 9.95});
    CHECK(found.is_complete);
    CHECK(found.highest == 9);
  }
}
