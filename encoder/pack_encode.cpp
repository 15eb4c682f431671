#include "encoder/pack_encode.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>
#include <string>

#include "encoder/approximation.hpp"
#include "encoder/crop.hpp"
#include "encoder/error.hpp"
#include "encoder/parallel.hpp"
#include "encoder/tile_plan.hpp"

namespace microtin {
namespace {

constexpr uint32_t kPilot = 257;  // posts on each side

// The z step that suits the middle of the raster best.
Decimal choose_z_step(const Raster& raster, const LatticeOptions& lattice,
                      SimplifyOptions options) {
  const uint32_t width = std::min(raster.width, kPilot), height = std::min(raster.height, kPilot);
  const Raster middle = crop(raster, PostRectangle{(raster.width - width) / 2,
                                                   (raster.height - height) / 2, width, height});
  if (options.search == Search::kNormal) options.search = Search::kFast;
  return approximate(middle, lattice, options).laid.z_step;
}

// Chooses the heights' lattice for all tiles.
TiledRaster tiled_raster(const Raster& raster, const PackOptions& options) {
  LatticeOptions lattice = options.lattice;
  if (options.simplify.bounded && !lattice.z_step) {
    try {
      lattice.z_step = choose_z_step(raster, lattice, options.simplify);
      return {raster, choose_post_lattice(raster, lattice), lattice, {}};
    } catch (const Error&) {  // too little terrain in the middle, or too fine for the whole
      lattice.z_step.reset();
    }
  }
  return {raster, choose_post_lattice(raster, lattice), lattice, {}};
}

// Posts that no tile covers. Throws Error if a post is a vertex already: nothing can cover it.
std::vector<GlobalPost> missing_posts(const TileGrid& grid, const std::vector<EncodedTile>& tiles) {
  std::map<GlobalPost, std::size_t> uncovered;  // by how many
  for (const EncodedTile& tile : tiles) {
    for (const GlobalPost post : tile.uncovered) ++uncovered[post];
  }
  std::vector<GlobalPost> missing;
  for (const auto& [post, count] : uncovered) {
    const std::vector<uint32_t> holders = tiles_at(grid, post);
    if (count < holders.size()) continue;
    if (std::all_of(holders.begin(), holders.end(),
                    [&](uint32_t tile) { return tiles[tile].stream.empty(); })) {
      throw Error("the height at column " + std::to_string(post.x) + ", row " +
                  std::to_string(post.y) +
                  " has too few around it for a triangle; another --tile-vertices may help");
    }
    missing.push_back(post);
  }
  return missing;
}

std::vector<EncodedTile> encode_tiles(const TiledRaster& tiled, const SimplifyOptions& options) {
  Borders borders(tiled);
  std::vector<EncodedTile> tiles(std::size_t{tile_columns(tiled.grid)} * tile_rows(tiled.grid));
  std::vector<uint32_t> changed(tiles.size());
  std::iota(changed.begin(), changed.end(), 0u);
  while (!changed.empty()) {  // ends: there are always more vertices on borders
    for_each_parallel(changed.size(), [&](std::size_t i) {
      const uint32_t tile = changed[i];
      tiles[tile] = encode_tile(tiled, tile, borders.of_tile(tile), options);
    });
    const std::set<uint32_t> again = borders.keep(missing_posts(tiled.grid, tiles));
    changed.assign(again.begin(), again.end());
  }
  return tiles;
}

uint32_t most_vertices(const std::vector<EncodedTile>& tiles) {
  uint32_t most = 0;
  for (const EncodedTile& tile : tiles) most = std::max(most, tile.vertices);
  return most;
}

Verification verification_of(const std::vector<EncodedTile>& tiles) {
  std::vector<Verification> parts;
  parts.reserve(tiles.size());
  for (const EncodedTile& tile : tiles) parts.push_back(tile.measured);
  return combine(parts);
}

}  // namespace

EncodedPack encode_pack(const Raster& raster, const PackOptions& options) {
  if (raster.width < 2 || raster.height < 2)
    throw Error("a pack needs two posts in each direction");
  TiledRaster tiled = tiled_raster(raster, options);
  std::vector<EncodedTile> tiles;
  uint32_t pieces = 0;
  do {  // a longer search seldom finds more vertices than the one for the plan
    pieces = choose_pieces(tiled, options.max_vertices, options.simplify, pieces + 1);
    tiled.grid = grid_of(raster, pieces);
    tiles = encode_tiles(tiled, options.simplify);
  } while (most_vertices(tiles) > options.max_vertices);
  const Verification measured = verification_of(tiles);
  return {tiled.grid, tiled.lattice.placement,
          make_decimal(tiled.lattice.z.step, tiled.lattice.z_decimals), std::move(tiles), measured};
}

}  // namespace microtin
