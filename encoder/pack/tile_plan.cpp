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
constexpr double kUsualCounts = 4, kCountOfTile = 0.25;

constexpr uint32_t kMostCounts = 5;  // where some fit

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

// Counts the vertices of the tiles that probably have most, at one size of tiles after the other.
class TileCounts {
 public:
  explicit TileCounts(const SimplifyOptions& options) : options_(options), quick_(options) {
    if (options.bounded) quick_.search = Search::kTrial;
  }

  // The most vertices of a tile; an estimate where that is surely allowed, or surely too many.
  uint32_t most(const TiledRaster& tiled, uint32_t allowed, const Progress& progress);

 private:
  // How much the part may differ from tile to tile.
  static constexpr double kSpread = 1.04;

  uint32_t likely(uint32_t quick_count) const {
    return static_cast<uint32_t>(std::lround(part_ * quick_count));
  }
  bool may_fit(uint32_t vertices, uint32_t allowed) const {
    return vertices <= allowed || long_search_may_fit(vertices, allowed, options_);
  }
  bool is_certain(uint32_t likely, uint32_t allowed) const {
    return likely * kSpread <= allowed ||
           !may_fit(static_cast<uint32_t>(likely / kSpread), allowed);
  }
  void search_longer(const TiledRaster& tiled, const std::vector<uint32_t>& tiles, uint32_t allowed,
                     std::vector<uint32_t>& counts) const;

  SimplifyOptions options_, quick_;
  // The part of the vertices after a short search that are left after the whole one: nearly the
  // same for all tiles of a terrain. 0: not known yet.
  double part_ = 0;
};

std::size_t largest_of(const std::vector<uint32_t>& counts) {
  return static_cast<std::size_t>(std::max_element(counts.begin(), counts.end()) - counts.begin());
}

// Counts the vertices of one tile, on all processors.
uint32_t count_alone(const TiledRaster& tiled, uint32_t tile, SimplifyOptions options) {
  options.threads = processors();
  return count_vertices(tiled, tile, options);
}

uint32_t TileCounts::most(const TiledRaster& tiled, uint32_t allowed, const Progress& progress) {
  const std::vector<uint32_t> tiles = roughest_tiles(tiled);
  std::vector<uint32_t> counts(tiles.size());
  CountedProgress done(progress, tiles.size());
  for_each_parallel(tiles.size(), [&](std::size_t i) {
    counts[i] = count_vertices(tiled, tiles[i], quick_);
    done.add_one();
  });
  const std::size_t largest = largest_of(counts);
  const uint32_t quick_count = counts[largest], guess = likely(quick_count);
  if (quick_.search == options_.search || quick_count == 0) return quick_count;
  if (part_ != 0 && is_certain(guess, allowed)) return guess;
  const uint32_t count = count_alone(tiled, tiles[largest], options_);
  part_ = static_cast<double>(count) / quick_count;
  if (!may_fit(count, allowed)) return count;
  for_each_parallel(tiles.size(), [&](std::size_t i) {
    const bool is_known = i == largest || likely(counts[i]) * kSpread <= allowed;
    counts[i] = is_known ? likely(counts[i]) : count_vertices(tiled, tiles[i], options_);
  });
  search_longer(tiled, tiles, allowed, counts);
  return counts[largest_of(counts)];
}

// Searches longer in the tiles that are too large, if all may fit then: first in the largest. If
// this one is still too large, the others do not matter.
void TileCounts::search_longer(const TiledRaster& tiled, const std::vector<uint32_t>& tiles,
                               uint32_t allowed, std::vector<uint32_t>& counts) const {
  const std::size_t largest = largest_of(counts);
  if (counts[largest] <= allowed || !may_fit(counts[largest], allowed)) return;
  const SimplifyOptions longer = with_long_search(options_);
  counts[largest] = count_alone(tiled, tiles[largest], longer);
  if (counts[largest] > allowed) return;
  for_each_parallel(tiles.size(), [&](std::size_t i) {
    if (counts[i] > allowed) counts[i] = count_vertices(tiled, tiles[i], longer);
  });
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
  TileCounts tile_counts(simplify);
  uint32_t fitting = 0, fewest = 1, counts = 0, pieces = guessed_pieces(frame, options);
  for (double done = 0;; done += (1 - done) / kUsualCounts) {
    tiled.grid = grid_of(frame, divide_up(longer, pieces));
    const uint32_t allowed = most_vertices(options, tiled.grid);
    const Progress part = progress.part(done, done + (1 - done) / kUsualCounts);
    const uint32_t most = tile_counts.most(tiled, allowed, part);
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
