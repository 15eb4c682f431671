#include "encoder/tile_plan.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "encoder/error.hpp"
#include "encoder/parallel.hpp"
#include "encoder/tile.hpp"
#include "microtin/pack.h"

namespace microtin {
namespace {

constexpr double kPostsPerVertex = 16;  // of simplified terrain, to begin with
constexpr uint32_t kKeptTiles = 4;

uint32_t divide_up(uint32_t a, uint32_t b) {
  return (a + b - 1) / b;
}

// The vertices of the tile that has most.
uint32_t most_vertices(const TiledRaster& tiled, const SimplifyOptions& options) {
  const Borders borders(tiled);
  std::vector<uint32_t> vertices(tile_columns(tiled.grid) * tile_rows(tiled.grid));
  for_each_parallel(vertices.size(), [&](std::size_t i) {
    const auto tile = static_cast<uint32_t>(i);
    const Survey survey = survey_of_tile(tiled, tile, borders.of_tile(tile));
    if (!has_terrain(tiled, tile, survey)) return;
    vertices[i] = static_cast<uint32_t>(simplify(survey, options).vertices.size());
  });
  return *std::max_element(vertices.begin(), vertices.end());
}

}  // namespace

TileGrid grid_of(const Raster& raster, uint32_t pieces) {
  return grid_of(raster.width - 1, raster.height - 1, pieces);
}

TileGrid grid_of(uint32_t x_max, uint32_t y_max, uint32_t pieces) {
  const uint32_t size = std::min(divide_up(std::max(x_max, y_max), pieces), uint32_t{kLatticeMax});
  const uint32_t width = divide_up(x_max, divide_up(x_max, size));
  const uint32_t height = divide_up(y_max, divide_up(y_max, size));
  return {x_max, y_max, static_cast<uint16_t>(width), static_cast<uint16_t>(height)};
}

uint32_t choose_pieces(TiledRaster tiled, uint32_t max_vertices, SimplifyOptions options,
                       uint32_t fewest) {
  options.search = options.bounded ? Search::kFast : options.search;
  const uint32_t longer = std::max(tiled.raster.width, tiled.raster.height) - 1;
  const double posts = options.bounded ? max_vertices * kPostsPerVertex : max_vertices;
  const auto guess = static_cast<uint32_t>(longer / std::max(std::sqrt(posts) - 1, 1.0)) + 1;
  uint32_t fitting = 0, pieces = std::clamp(guess, std::min(fewest, longer), longer);
  for (;;) {
    tiled.grid = grid_of(tiled.raster, pieces);
    const uint32_t most = most_vertices(tiled, options);
    if (most <= max_vertices) fitting = pieces;
    if (most > max_vertices) fewest = pieces + 1;
    const double ratio = std::sqrt(static_cast<double>(most) / max_vertices);
    const uint32_t next = std::max(fewest, static_cast<uint32_t>(std::ceil(pieces * ratio)));
    if (fitting != 0 && next >= fitting) return fitting;
    if (fewest > longer) {
      throw Error("--tile-vertices " + std::to_string(max_vertices) +
                  " is not enough for tiles of one step: " + std::to_string(most));
    }
    pieces = std::min(next, longer);
  }
}

uint32_t vertices_for_ram(uint64_t bytes) {
  uint32_t vertices = 10923;  // the most with 16-bit numbers
  while (vertices >= 3 && MICROTIN_PACK_BYTES_FOR(kKeptTiles, vertices, 16) > bytes) --vertices;
  return vertices >= 3 ? vertices : 0;
}

}  // namespace microtin
