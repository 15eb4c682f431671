// SPDX-License-Identifier: MIT
// Tries the roughest tiles at some sizes.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/base/work.hpp"
#include "encoder/pack/encode.hpp"
#include "encoder/pack/tile.hpp"
#include "encoder/terrain/raster_scan.hpp"
#include "microtin/compact_pack.h"

namespace microtin::pack {
namespace {

constexpr double kPostsPerVertex = 16;  // of simplified terrain, to begin with

uint32_t divide_up(uint32_t a, uint32_t b) {
  return (a + b - 1) / b;
}

constexpr std::size_t kSimplifiedTiles = 24;

// How often tiles are counted, and how much of encoding them that takes: guesses, for the time left
// alone.
constexpr double kUsualCounts = 4, kCountOfTile = 0.4;

constexpr uint32_t kMostCounts = 5;    // where some fit
constexpr double kQuickExcess = 1.33;  // of vertices after a fast search: at most, about

// The tiles that probably have most vertices.
std::vector<uint32_t> roughest_tiles(const TiledRaster& tiled) {
  const std::size_t count = tile_count(tiled.grid), kept = std::min(count, kSimplifiedTiles);
  std::vector<uint32_t> tiles(count);
  std::iota(tiles.begin(), tiles.end(), 0u);
  if (kept == count) return tiles;
  std::vector<uint64_t> rough(count);
  for_each_parallel(count, [&](std::size_t i) {
    const TilePosts posts(tiled, tiles[i]);
    rough[i] = roughness(posts.tile(), tiled.options.max_error);
  });
  const auto rougher = [&](uint32_t a, uint32_t b) {
    return rough[a] != rough[b] ? rough[a] > rough[b] : a < b;
  };
  std::partial_sort(tiles.begin(), tiles.begin() + static_cast<std::ptrdiff_t>(kept), tiles.end(),
                    rougher);
  tiles.resize(kept);
  return tiles;
}

// The vertices of the tile that probably has most, by a fast search. Tiles that are a little too
// large that way are counted as they will be encoded.
uint32_t most_vertices(const TiledRaster& tiled, uint32_t max_vertices,
                       const SimplifyOptions& options, const Progress& progress) {
  SimplifyOptions quick = options;
  if (options.bounded) quick.search = Search::kFast;
  const std::vector<uint32_t> tiles = roughest_tiles(tiled);
  std::vector<uint32_t> vertices(tiles.size());
  CountedProgress done(progress, tiles.size());
  for_each_parallel(tiles.size(), [&](std::size_t i) {
    vertices[i] = count_vertices(tiled, tiles[i], quick);
    const bool nearly_fits =
        vertices[i] > max_vertices && vertices[i] <= max_vertices * kQuickExcess;
    if (nearly_fits && quick.search != options.search) {
      vertices[i] = count_vertices(tiled, tiles[i], options);
    }
    done.add_one();
  });
  const auto most = [&] { return *std::max_element(vertices.begin(), vertices.end()); };
  if (!long_search_may_fit(most(), max_vertices, options)) return most();
  for_each_parallel(tiles.size(), [&](std::size_t i) {
    if (vertices[i] <= max_vertices) return;
    vertices[i] = count_vertices(tiled, tiles[i], with_long_search(options));
  });
  return most();
}

// Into how many pieces the longer side goes, to begin with.
uint32_t guessed_pieces(const Raster& frame, const PackOptions& options) {
  const uint32_t longer = std::max(frame.width, frame.height) - 1;
  const double posts =
      options.simplify.bounded ? options.max_vertices * kPostsPerVertex : options.max_vertices;
  const auto guess = static_cast<uint32_t>(longer / std::max(std::sqrt(posts) - 1, 1.0)) + 1;
  return std::clamp(guess, 1u, longer);
}

[[noreturn]] void fail_at_one_step(uint32_t max_vertices, uint32_t most) {
  throw Error(parameter("tile_vertices") + ' ' + std::to_string(max_vertices) +
              " is too small: a tile of one step has " + std::to_string(most) + "; use at least " +
              "that");
}

}  // namespace

TileGrid grid_of(const Raster& frame, uint32_t tile_size) {
  constexpr uint32_t kMostSparse = kLatticeMax / 2;  // with the posts around, 16 bits hold places
  const uint32_t most = is_sparse(frame) ? std::min(tile_size, kMostSparse) : tile_size;
  const TileGrid grid = grid_of(frame.width - 1, frame.height - 1, most);
  if (has_too_many_tiles(grid)) {
    throw Error("the pack has " + std::to_string(tile_count(grid)) + " tiles of " +
                std::to_string(std::max(grid.width, grid.height)) + " steps, more than " +
                std::to_string(kMostTiles) + "; increase " + parameter("tile_size") + " or " +
                parameter("tile_vertices") + ", or make a pack of each part");
  }
  return grid;
}

TileGrid grid_of(uint32_t x_max, uint32_t y_max, uint32_t tile_size) {
  const uint32_t size = std::min(tile_size, uint32_t{kLatticeMax});
  const uint32_t width = divide_up(x_max, divide_up(x_max, size));
  const uint32_t height = divide_up(y_max, divide_up(y_max, size));
  return {x_max, y_max, static_cast<uint16_t>(width), static_cast<uint16_t>(height)};
}

double counting_part(const Raster& frame, const PackOptions& options) {
  const double longer = std::max(frame.width, frame.height),
               pieces = guessed_pieces(frame, options);
  const double tiles = pieces * pieces * std::min(frame.width, frame.height) / longer;
  const double counted = std::min(tiles, double{kSimplifiedTiles}) * kUsualCounts * kCountOfTile;
  return counted / (counted + tiles);
}

uint32_t choose_tile_size(TiledRaster tiled, const PackOptions& options, const Progress& progress) {
  SimplifyOptions simplify = options.simplify;
  simplify.progress = {};
  const Raster& frame = tiled.raster.frame();
  const uint32_t longer = std::max(frame.width, frame.height) - 1;
  uint32_t fitting = 0, fewest = 1, counts = 0, pieces = guessed_pieces(frame, options);
  for (double done = 0;; done += (1 - done) / kUsualCounts) {
    tiled.grid = grid_of(frame, divide_up(longer, pieces));
    const uint32_t allowed = most_vertices(options, tiled.grid);
    const Progress part = progress.part(done, done + (1 - done) / kUsualCounts);
    const uint32_t most = most_vertices(tiled, allowed, simplify, part);
    if (most <= allowed) fitting = pieces;
    if (most > allowed) fewest = pieces + 1;
    const double ratio = std::sqrt(static_cast<double>(most) / allowed);
    const auto likely = static_cast<uint32_t>(std::ceil(pieces * ratio));
    const uint32_t fewer = fitting != 0 ? fitting - 1 : longer;  // not every tile grows alike
    const uint32_t next = std::max(fewest, std::min(likely, fewer));
    const bool is_last = ++counts >= kMostCounts;
    if (fitting != 0 && (next >= fitting || is_last)) return divide_up(longer, fitting);
    if (fewest > longer) fail_at_one_step(allowed, most);
    pieces = std::min(next, longer);
  }
}

uint32_t smaller_tile_size(const TileGrid& grid, uint32_t max_vertices, uint32_t vertices) {
  const uint32_t steps = std::max(grid.width, grid.height);
  if (steps == 1) fail_at_one_step(max_vertices, vertices);
  const double ratio = std::sqrt(static_cast<double>(max_vertices) / vertices);
  return std::clamp(static_cast<uint32_t>(steps * ratio), 1u, steps - 1);
}

uint64_t pack_ram(uint32_t vertices, uint64_t tile_bytes, uint32_t kept_tiles) {
  const uint32_t bits = index_bits(vertices);
  return MICROTIN_COMPACT_PACK_BYTES_FOR(kept_tiles, uint64_t{vertices}, tile_bytes, bits);
}

uint32_t vertices_for_ram(uint64_t bytes, bool is_narrow, uint32_t kept_tiles) {
  uint32_t vertices = MICROTIN_MAX_VERTICES_FOR(16);
  while (vertices >= 3 &&
         pack_ram(vertices, promised_compact_bytes(vertices, is_narrow, 16), kept_tiles) > bytes) {
    --vertices;
  }
  return vertices >= 3 ? vertices : 0;
}

}  // namespace microtin::pack
