// SPDX-License-Identifier: MIT
// Asks streams and packs for heights; keeps two rows of a pack's tiles decoded.
#include "encoder/export/height_sampler.hpp"

#include <algorithm>

#include "encoder/base/error.hpp"
#include "encoder/exact/mesh_vertex.hpp"

namespace microtin::exporting {
namespace {

constexpr int64_t kFraction = 256;  // places have 8 fractional bits

std::optional<int32_t> ask(const microtin_mesh* mesh, int64_t x, int64_t y, uint32_t& hint) {
  int32_t height = 0;
  const microtin_answer answer =
      microtin_height_at(mesh, static_cast<int32_t>(x), static_cast<int32_t>(y), 0, &hint, &height);
  if (answer != MICROTIN_HEIGHT) return std::nullopt;
  return height;
}

class PackSampler {
 public:
  explicit PackSampler(const PackFile& pack) : pack_(pack), grid_(pack.grid()) {}

  std::optional<int32_t> height_at(int64_t x, int64_t y) {
    const Range columns = tiles(x, grid_.width, tile_columns(grid_));
    const Range rows = tiles(y, grid_.height, tile_rows(grid_));
    for (uint32_t row = rows.first; row <= rows.last; ++row) {
      for (uint32_t column = columns.first; column <= columns.last; ++column) {
        const auto height = ask_tile(row * tile_columns(grid_) + column, x, y);
        if (height) return height;
      }
    }
    return std::nullopt;
  }

 private:
  struct Range {
    uint32_t first, last;
  };
  struct Tile {
    std::optional<DecodedTerrain> terrain;
    uint32_t hint = 0;
  };

  // On a border two tiles have a say.
  static Range tiles(int64_t place, uint32_t side, uint32_t count) {
    const int64_t width = side * kFraction;
    const auto last = static_cast<uint32_t>(std::min<int64_t>(place / width, count - 1));
    return {place % width == 0 && place == last * width && last != 0 ? last - 1 : last, last};
  }

  std::optional<int32_t> ask_tile(uint32_t number, int64_t x, int64_t y) {
    const auto [found, is_new] = tiles_.try_emplace(number);
    Tile& tile = found->second;
    if (is_new) {
      tile.terrain = pack_.tile(number);
      const uint32_t columns = tile_columns(grid_);
      tiles_.erase(tiles_.lower_bound((number / columns + 2) * columns), tiles_.end());
    }
    if (!tile.terrain) return std::nullopt;
    const TileBox box = tile_box(grid_, number);
    return ask(tile.terrain->mesh(), x - box.x * kFraction, y - box.y * kFraction, tile.hint);
  }

  const PackFile& pack_;
  TileGrid grid_;
  std::map<uint32_t, Tile> tiles_;  // the last row's and the one's north of it
};

}  // namespace

SampledSurface sampled(const microtin_mesh* mesh) {
  SampledSurface surface;
  microtin_placement(mesh, &surface.placement.x, &surface.placement.y, &surface.placement.z);
  for (uint32_t v = 0; v < microtin_vertex_count(mesh); ++v) {
    const auto [x, y, z] = vertex_of(mesh, v);
    surface.x_min = v == 0 ? x : std::min<int64_t>(surface.x_min, x);
    surface.y_min = v == 0 ? y : std::min<int64_t>(surface.y_min, y);
    surface.x_max = std::max<int64_t>(surface.x_max, x);
    surface.y_max = std::max<int64_t>(surface.y_max, y);
    surface.lowest = v == 0 ? z : std::min<int32_t>(surface.lowest, z);
  }
  surface.height_at = [mesh, hint = uint32_t{0}](int64_t x, int64_t y) mutable {
    return ask(mesh, x, y, hint);
  };
  return surface;
}

SampledSurface sampled(const PackFile& pack) {
  SampledSurface surface;
  surface.placement = pack.metadata().placement;
  surface.x_max = pack.grid().x_max;
  surface.y_max = pack.grid().y_max;
  surface.lowest = pack.header().lowest;
  const auto sampler = std::make_shared<PackSampler>(pack);
  surface.height_at = [sampler](int64_t x, int64_t y) { return sampler->height_at(x, y); };
  return surface;
}

}  // namespace microtin::exporting
