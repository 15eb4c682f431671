// SPDX-License-Identifier: MIT
// Both sides of every border of a pack, compared exactly.
#ifndef MICROTIN_TESTS_SUPPORT_BORDER_WALK_HPP
#define MICROTIN_TESTS_SUPPORT_BORDER_WALK_HPP

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/pack/borders.hpp"
#include "encoder/pack/file.hpp"
#include "tests/support/layers.hpp"

namespace microtin::tests {

// The tiles of a pack, decoded.
class Tiles {
 public:
  explicit Tiles(const PackFile& pack) : grid_(pack.grid()) {
    for (uint32_t i = 0; i < pack.entries().size(); ++i) tiles_.push_back(pack.tile(i));
  }

  // The answer of one tile at a place with 8 fractional bits.
  microtin_query_result ask(uint32_t tile, int64_t x, int64_t y, int32_t& height) const {
    if (!tiles_[tile]) return MICROTIN_QUERY_VOID;
    const TileBox box = tile_box(grid_, tile);
    uint32_t hint = 0;
    return microtin_mesh_height_at(
        tiles_[tile]->mesh(), static_cast<int32_t>(x - int64_t{box.x} * 256),
        static_cast<int32_t>(y - int64_t{box.y} * 256), &hint, &height, 0, 0);
  }

  bool has_terrain(uint32_t tile) const { return tiles_[tile].has_value(); }

  const TileGrid& grid() const { return grid_; }

 private:
  TileGrid grid_;
  std::vector<std::optional<DecodedTerrain>> tiles_;
};

struct BorderCount {
  uint64_t places = 0, both = 0, differ = 0, wrong_posts = 0;
  uint64_t one_sided = 0;  // a tile with terrain does not know the height, another does
};

// The tiles that hold a place with 8 fractional bits. One between two places of a border lies in
// the tiles that hold both.
inline std::vector<uint32_t> holders_of(const TileGrid& grid, int64_t x, int64_t y) {
  const GlobalPost post{static_cast<uint32_t>(x / 256), static_cast<uint32_t>(y / 256)};
  const GlobalPost after{post.x + (x % 256 != 0), post.y + (y % 256 != 0)};
  const std::vector<uint32_t> others = tiles_at(grid, after);
  std::vector<uint32_t> holders;
  for (const uint32_t tile : tiles_at(grid, post)) {
    if (std::count(others.begin(), others.end(), tile) != 0) holders.push_back(tile);
  }
  return holders;
}

// Asks all tiles that hold a place. Returns whether one of them knows a height.
inline bool compare_at(const Tiles& tiles, int64_t x, int64_t y, BorderCount& count) {
  std::vector<int32_t> heights;
  bool missing = false;
  for (const uint32_t tile : holders_of(tiles.grid(), x, y)) {
    int32_t height = 0;
    if (tiles.ask(tile, x, y, height) == MICROTIN_QUERY_OK) {
      heights.push_back(height);
    } else if (tiles.has_terrain(tile)) {
      missing = true;
    }
  }
  ++count.places;
  if (missing && !heights.empty()) ++count.one_sided;
  if (heights.size() > 1) ++count.both;
  for (const int32_t height : heights) {
    if (height != heights[0]) ++count.differ;
  }
  return !heights.empty();
}

// Compares at a place where a post knows whether there is a height.
inline void compare_at(const Tiles& tiles, int64_t x, int64_t y, const Raster& raster,
                       BorderCount& count) {
  const bool answered = compare_at(tiles, x, y, count);
  if (x % 256 != 0 || y % 256 != 0) return;
  const size_t post = static_cast<size_t>(y / 256) * raster.width + static_cast<size_t>(x / 256);
  if (raster.heights[post] == kNoPost) return;
  if ((raster.heights[post] == kVoidHeight) == answered) ++count.wrong_posts;
}

// Walks all borders in eighths of a step.
inline BorderCount walk_borders(const PackFile& pack, const Raster& raster) {
  const Tiles tiles(pack);
  const TileGrid& grid = pack.grid();
  BorderCount count;
  for (int64_t x = grid.width; x < grid.x_max; x += grid.width) {
    for (int64_t y = 0; y <= int64_t{grid.y_max} * 256; y += 32) {
      compare_at(tiles, x * 256, y, raster, count);
    }
  }
  for (int64_t y = grid.height; y < grid.y_max; y += grid.height) {
    for (int64_t x = 0; x <= int64_t{grid.x_max} * 256; x += 32) {
      compare_at(tiles, x, y * 256, raster, count);
    }
  }
  return count;
}

}  // namespace microtin::tests

#endif
