// Both sides of every border of a pack, compared exactly.
#ifndef MICROTIN_TESTS_BORDER_WALK_HPP
#define MICROTIN_TESTS_BORDER_WALK_HPP

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/borders.hpp"
#include "encoder/pack_file.hpp"

namespace microtin {

// The tiles of a pack, decoded.
class Tiles {
 public:
  explicit Tiles(const PackFile& pack) : grid_(pack.grid()) {
    for (uint32_t i = 0; i < pack.entries().size(); ++i) tiles_.push_back(pack.tile(i));
  }

  // The answer of one tile at a place with 8 fractional bits.
  microtin_answer ask(uint32_t tile, int64_t x, int64_t y, int32_t& height) const {
    if (!tiles_[tile]) return MICROTIN_IN_VOID;
    const TileBox box = tile_box(grid_, tile);
    uint32_t hint = 0;
    return microtin_height_at(tiles_[tile]->mesh(), static_cast<int32_t>(x - int64_t{box.x} * 256),
                              static_cast<int32_t>(y - int64_t{box.y} * 256), 0, &hint, &height);
  }

  const TileGrid& grid() const { return grid_; }

 private:
  TileGrid grid_;
  std::vector<std::optional<DecodedTerrain>> tiles_;
};

struct BorderCount {
  uint64_t places = 0, both = 0, differ = 0, wrong_posts = 0;
};

// Asks all tiles that hold a place.
inline void compare_at(const Tiles& tiles, int64_t x, int64_t y, const Raster& raster,
                       BorderCount& count) {
  const GlobalPost post{static_cast<uint32_t>(x / 256), static_cast<uint32_t>(y / 256)};
  // A place between two posts of a border lies in the tiles that hold the middle between them.
  std::vector<uint32_t> holders = tiles_at(tiles.grid(), post);
  if (x % 256 != 0 || y % 256 != 0) {
    const GlobalPost after{post.x + (x % 256 != 0), post.y + (y % 256 != 0)};
    const std::vector<uint32_t> others = tiles_at(tiles.grid(), after);
    std::vector<uint32_t> common;
    for (const uint32_t t : holders) {
      if (std::count(others.begin(), others.end(), t) != 0) common.push_back(t);
    }
    holders = common;
  }
  std::vector<int32_t> heights;
  for (const uint32_t tile : holders) {
    int32_t height = 0;
    if (tiles.ask(tile, x, y, height) == MICROTIN_HEIGHT) heights.push_back(height);
  }
  ++count.places;
  if (heights.size() > 1) ++count.both;
  for (const int32_t height : heights) {
    if (height != heights[0]) ++count.differ;
  }
  if (x % 256 != 0 || y % 256 != 0) return;
  const bool is_void = raster.heights[size_t{post.y} * raster.width + post.x] == kVoidHeight;
  if (is_void != heights.empty()) ++count.wrong_posts;
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

}  // namespace microtin

#endif
