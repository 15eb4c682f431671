// SPDX-License-Identifier: MIT
// Surfaces as ESRI ASCII grids.
#include "encoder/export/grid.hpp"

#include <doctest/doctest.h>

#include <fstream>
#include <sstream>

#include "encoder/fit/approximation.hpp"
#include "encoder/import/import.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/terrain/lay_out.hpp"
#include "tests/support/packs.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace microtin::tests;

namespace {

std::string grid(const SampledSurface& surface, const std::optional<Decimal>& cell = {}) {
  const TemporaryFolder folder;
  OutputFile out(folder / "grid.asc");
  export_grid(surface, cell, out);
  out.commit();
  std::ostringstream text;
  text << std::ifstream(folder / "grid.asc").rdbuf();
  return text.str();
}

// Every post a vertex.
DecodedTerrain decoded(const Source& source) {
  const Laid laid = lay_out(source, {});
  Metadata metadata;
  metadata.placement = laid.placement;
  return encode_and_decode(simplify(laid.survey, {}), metadata, {}).decoded;
}

Raster read_back(const std::string& text) {
  return import_asc("grid.asc", text);
}

bool same(const Axis& a, const Axis& b) {
  return Wide{a.offset} * static_cast<Wide>(b.denominator) ==
             Wide{b.offset} * static_cast<Wide>(a.denominator) &&
         static_cast<Wide>(a.numerator) * static_cast<Wide>(b.denominator) ==
             static_cast<Wide>(b.numerator) * static_cast<Wide>(a.denominator);
}

// Two triangles over (0, 0), (4, 0), (0, 4) and (4, 4) with heights 0, 4, 8 and 13.
DecodedTerrain square(const Placement& placement) {
  Tin tin;
  tin.vertices = {{0, 0, 0}, {4, 0, 4}, {0, 4, 8}, {4, 4, 13}};
  Metadata metadata;
  metadata.placement = placement;
  return DecodedTerrain(encode(tin, metadata));
}

}  // namespace

TEST_CASE("grid: posts at the lattice's places, heights between vertices") {
  const DecodedTerrain terrain = square({{5000005, 5, 10}, {-1, 5, 10}, {0, 1, 3}});
  const std::string text = grid(sampled(terrain.mesh()));
  CHECK(text.find("ncols 5\nnrows 5\nxllcenter 500000.5\nyllcenter -0.1\ncellsize 0.5\n"
                  "NODATA_value -9999\n2.666666667 ") == 0);
  CHECK(text.substr(text.rfind('\n', text.size() - 2)) ==
        "\n0 0.333333333 0.666666667 1 1.333333333\n");
}

TEST_CASE("grid: cells of any size, from the south-west corner on") {
  const DecodedTerrain terrain = square({{0, 1, 1}, {0, 2, 1}, {0, 1, 1}});
  CHECK(grid(sampled(terrain.mesh())).find("dx 1\ndy 2\n") != std::string::npos);
  const std::string text = grid(sampled(terrain.mesh()), Decimal{15, 1});
  CHECK(text.find("ncols 3\nnrows 6\nxllcenter 0\nyllcenter 0\ncellsize 1.5\n") == 0);
  CHECK(text.substr(text.rfind('\n', text.size() - 2)) == "\n0 1.5 3\n");
  CHECK(grid(sampled(terrain.mesh()), Decimal{100, 0}).find("ncols 1\nnrows 1\n") == 0);
}

TEST_CASE("grid: the value for voids is below every height") {
  const DecodedTerrain terrain = square({{0, 1, 1}, {0, 1, 1}, {-99999, 1, 1}});
  CHECK(grid(sampled(terrain.mesh())).find("NODATA_value -999999\n") != std::string::npos);
}

TEST_CASE("grid: what is written is read back as the same raster, voids included") {
  for (const VoidKind& kind : void_kinds()) {
    Raster raster = rough_raster(61, 53, kind.at);
    for (const auto& [x, y] : {std::pair<Axis, Axis>{{7 * 1200, 1, 1200}, {43 * 1200, 1, 1200}},
                               {{2 * -72 * 3600 + 1, 2, 7200}, {-5 * 3600, 1, 3600}},
                               {{639000123, 1000, 1000}, {-485, 1000, 1000}},
                               {{100, 25, 10}, {0, 25, 10}}}) {
      raster.x = x;
      raster.y = y;
      const DecodedTerrain terrain = decoded(raster);
      const Raster again = read_back(grid(sampled(terrain.mesh())));
      // Void columns and rows at the rim are outside the surface.
      size_t south_west = raster.heights.size();
      uint32_t dx = 0, dy = 0;
      for (uint32_t shift_y = 0; shift_y + again.height <= raster.height; ++shift_y) {
        for (uint32_t shift_x = 0; shift_x + again.width <= raster.width; ++shift_x) {
          Axis moved_x = raster.x, moved_y = raster.y;
          moved_x.offset += shift_x * static_cast<int64_t>(raster.x.numerator);
          moved_y.offset += shift_y * static_cast<int64_t>(raster.y.numerator);
          if (!same(moved_x, again.x) || !same(moved_y, again.y)) continue;
          south_west = size_t{shift_y} * raster.width + shift_x;
          dx = shift_x;
          dy = shift_y;
        }
      }
      REQUIRE_MESSAGE(south_west < raster.heights.size(), kind.name);
      size_t different = 0;
      for (uint32_t row = 0; row < raster.height; ++row) {
        for (uint32_t column = 0; column < raster.width; ++column) {
          const bool inside =
              column >= dx && column - dx < again.width && row >= dy && row - dy < again.height;
          const int64_t found =
              inside ? again.heights[size_t{row - dy} * again.width + column - dx] : kVoidHeight;
          if (found != raster.heights[size_t{row} * raster.width + column]) ++different;
        }
      }
      CHECK_MESSAGE(different == 0, kind.name);
      CHECK(again.decimals == 0);
    }
  }
}

TEST_CASE("grid: a pack is one surface, with the posts of its raster") {
  for (const VoidKind& kind : void_kinds()) {
    Raster raster = rough_raster(61, 53, kind.at);
    raster.x = {8400, 1, 1200};
    const PackFile pack(write_pack(encode_pack(raster, pack_options(0, 100))));
    const Raster again = read_back(grid(sampled(pack)));
    CHECK(again.width == raster.width);
    CHECK(again.height == raster.height);
    CHECK(same(again.x, raster.x));
    CHECK_MESSAGE(again.heights == raster.heights, kind.name);
  }
}
