// SPDX-License-Identifier: MIT
// Surfaces as ESRI ASCII grids.
#include "encoder/export/grid.hpp"

#include <doctest/doctest.h>

#include <fstream>
#include <memory>
#include <sstream>
#include <utility>
#include <vector>

#include "encoder/exact/lattice_map.hpp"
#include "encoder/files/input.hpp"
#include "encoder/fit/simplify.hpp"
#include "encoder/import/import.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/terrain/lay_out.hpp"
#include "tests/support/packs.hpp"
#include "tests/support/slow.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace microtin::tests;

namespace {

std::string grid(const SampledSurface& surface, const PostGrid& posts) {
  const TemporaryFolder folder;
  OutputFile out(folder / "grid.asc");
  export_grid(surface, posts, out);
  out.commit();
  std::ostringstream text;
  text << std::ifstream(folder / "grid.asc").rdbuf();
  CHECK(static_cast<double>(text.str().size()) <= 200 + most_grid_bytes(surface, posts));
  return text.str();
}

std::string grid(const SampledSurface& surface) {
  return grid(surface, lattice_grid(surface));
}

std::string grid(const SampledSurface& surface, Decimal cell) {
  return grid(surface, grid_of_cells(surface, cell));
}

std::string grid(const SampledSurface& surface, const std::string& extent, Decimal cell) {
  return grid(surface, grid_of_cells(parse_extent(extent).value(), cell));
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

TEST_CASE("grid: an extent's posts begin at its south-west corner, or are those of a grid") {
  const DecodedTerrain terrain = square({{100, 1, 1}, {0, 1, 1}, {0, 1, 1}});
  const SampledSurface surface = sampled(terrain.mesh());
  CHECK(grid(surface, "99.5,-1,102.5,1.9", {1, 0})
            .find("ncols 4\nnrows 3\nxllcenter 99.5\n"
                  "yllcenter -1\ncellsize 1\n") == 0);
  const std::string rows = grid(surface, "99.5,-1,102.5,1.9", {1, 0});
  CHECK(rows.substr(rows.find("-9999\n") + 6) ==
        "-9999 2.5 3.5 4.5\n-9999 0.5 1.5 2.5\n-9999 -9999 -9999 -9999\n");
  const PostGrid posts{3, 2, {100, 2, 1}, {1, 2, 1}};  // at 100, 102, 104 and 1, 3
  const auto within = [&](const std::string& extent) {
    return posts_within(posts, parse_extent(extent).value(), false);
  };
  const PostGrid all = within("100,1,104,3"), west = within("99,0.5,101.999,3.1"),
                 wide = within("95.9,-1.0,104,9");
  CHECK((all.columns == 3 && all.rows == 2 && is_same(all.x, posts.x) && is_same(all.y, posts.y)));
  CHECK((west.columns == 1 && west.rows == 2 && is_same(west.x, posts.x)));
  CHECK((wide.columns == 5 && wide.rows == 6 && is_same(wide.x, {96, 2, 1}) &&
         is_same(wide.y, {-1, 2, 1})));
  CHECK_THROWS_WITH_AS(within("100.1,1,101.9,3"),
                       "no post of the grid lies in the extent; choose a larger one", Error);
  CHECK(meets(surface, within("95,1,100,3")));
  CHECK(!meets(surface, within("95,1,99,3")));
  CHECK(!meets(surface, within("104,5,107,9")));
}

TEST_CASE("grid: an extent has a grid's own posts by either name of their longitudes") {
  const PostGrid posts{29, 2, {17900, 7, 100}, {0, 1, 1}};  // from 179 to 180.96
  const auto first_within = [](const PostGrid& grid, const std::string& extent, bool is_degrees) {
    return posts_within(grid, parse_extent(extent).value(), is_degrees).x;
  };
  const std::string east = "180,0,180.5,1", west = "-180,0,-179.5,1", none = "-90,0,-89,1";
  CHECK(is_same(first_within(posts, east, true), {18005, 7, 100}));
  CHECK(is_same(first_within(posts, west, true), {-17995, 7, 100}));
  CHECK(is_same(first_within(posts, west, false), {-17996, 7, 100}));  // 0.07 do not divide 360
  CHECK(is_same(first_within(posts, none, true), first_within(posts, none, false)));
  const PostGrid named_west{29, 2, {-18100, 7, 100}, {0, 1, 1}};  // from -181
  CHECK(is_same(first_within(named_west, "179,0,180,1", true), {17900, 7, 100}));
}

TEST_CASE("grid: the posts of an extent are found in numbers of any size") {
  const PostGrid tiny = grid_of_cells(parse_extent("0,0,0.000000002,1").value(), {1, 9});
  CHECK((tiny.columns == 3 && tiny.rows == 1000000001));
  CHECK_THROWS_AS(grid_of_cells(parse_extent("0,0,1,999999999999").value(), {1, 9}), Error);
  CHECK_THROWS_AS(posts_within({1, 1, {0, 1, 1}, {0, 1, 1}},
                               parse_extent("-999999999999,0,999999999999,1").value(), false),
                  Error);
  const PostGrid far = grid_of_cells(
      parse_extent("999999999000.000000000001,0,999999999999.000000000001,1").value(), {1, 0});
  CHECK((far.columns == 1000 && far.rows == 2));
  for (const char* const text :
       {"", "1,2,3", "1,2,3,", "3,2,1,4", "1,2,1,4", "1,4,3,2", "1,2,3,4,5", "1;2;3;4", "a,2,3,4",
        "0,0,1000000000000,1", "-1e12,0,1,1"}) {
    CHECK_MESSAGE(!parse_extent(text), text);
  }
}

TEST_CASE("grid: what is written is read back as the same raster, voids at the margins included" *
          kSlow) {
  for (const VoidKind& kind : void_kinds()) {
    Raster raster = rough_raster(61, 53, kind.at);
    for (const auto& [x, y] : {std::pair<Axis, Axis>{{7 * 1200, 1, 1200}, {43 * 1200, 1, 1200}},
                               {{2 * -72 * 3600 + 1, 2, 7200}, {-5 * 3600, 1, 3600}},
                               {{639000123, 1000, 1000}, {-485, 1000, 1000}},
                               {{100, 25, 10}, {0, 25, 10}}}) {
      raster.x = x;
      raster.y = y;
      const DecodedTerrain terrain = decoded(raster);
      const Raster again = read_back(grid(sampled(terrain.mesh()), posts_of(raster)));
      CHECK(again.width == raster.width);
      CHECK(is_same(again.x, raster.x));
      CHECK(is_same(again.y, raster.y));
      CHECK_MESSAGE(again.heights == raster.heights, kind.name);
      CHECK(again.decimals == 0);
    }
  }
}

TEST_CASE("grid: a pack is one surface, with the posts of its raster" * kSlow) {
  for (const VoidKind& kind : void_kinds()) {
    Raster raster = rough_raster(61, 53, kind.at);
    raster.x = {8400, 1, 1200};
    const PackFile pack(write_pack(encode_pack(raster, pack_options(0, 100))));
    const Raster again = read_back(grid(sampled(pack)));
    CHECK(again.width == raster.width);
    CHECK(again.height == raster.height);
    CHECK(is_same(again.x, raster.x));
    CHECK_MESSAGE(again.heights == raster.heights, kind.name);
  }
}

namespace {

// Counts how often bytes behind an offset are read.
class CountedBytes : public microtin::files::ByteSource {
 public:
  CountedBytes(std::vector<uint8_t> bytes, uint64_t from, uint32_t& count)
      : bytes_(microtin::files::bytes_in_memory(std::move(bytes))), from_(from), count_(count) {}
  uint64_t size() const override { return bytes_->size(); }
  std::size_t read(uint64_t offset, void* to, std::size_t size) const override {
    if (offset >= from_) ++count_;
    return bytes_->read(offset, to, size);
  }

 private:
  std::unique_ptr<microtin::files::ByteSource> bytes_;
  uint64_t from_;
  uint32_t& count_;
};

}  // namespace

TEST_CASE("sampled packs: the tiles kept are limited by their vertices, and at least four") {
  PackOptions options = pack_options(2, 400);
  options.tile_size = 10;
  const std::vector<uint8_t> bytes = write_pack(encode_pack(rough_raster(121, 11), options));
  const PackFile plain(bytes);
  const uint64_t streams = pack_entry_start(plain.header(), 12);
  for (const auto& [kept, again] : {std::pair(uint64_t{1} << 24, 0u), std::pair(uint64_t{1}, 8u)}) {
    uint32_t reads = 0;
    const PackFile pack(std::make_unique<CountedBytes>(bytes, streams, reads));
    REQUIRE(tile_columns(pack.grid()) == 12);
    const SampledSurface surface = sampled(pack, BadTiles::kThrow, kept);
    const auto ask = [&](int64_t tile) {
      CHECK(surface.height_at(place_on_lattice(10 * tile + 5, 5)).kind == MICROTIN_QUERY_OK);
    };
    for (int64_t tile = 0; tile < 12; ++tile) ask(tile);
    CHECK(reads == 12);
    for (int64_t tile = 11; tile >= 0; --tile) ask(tile);
    CHECK(reads == 12 + again);
  }
}
