// SPDX-License-Identifier: MIT
// Compares the tiles of an old pack with the posts of the changed raster.
#include "encoder/pack/kept_tiles.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/terrain/exact_query.hpp"
#include "encoder/verify/breaklines.hpp"
#include "encoder/verify/everywhere.hpp"
#include "encoder/verify/verify.hpp"

namespace microtin::pack {
namespace {

// Whether a post with a height lies on no border, so that no other tile has it.
bool has_own_posts(const TilePosts& posts, const TileSides& sides) {
  bool found = false;
  for_each_post(posts.tile(), [&](int64_t x, int64_t y, int64_t z) {
    const Point p{static_cast<uint16_t>(x), static_cast<uint16_t>(y)};
    if (z != kVoidHeight && !sides.shares(p)) found = true;
  });
  return found;
}

SharedVertices border_of(const microtin_mesh* mesh, const TileSides& sides) {
  SharedVertices border;
  for (uint32_t v = 0; v < microtin_mesh_vertex_count(mesh); ++v) {
    const auto [x, y, z] = vertex_of(mesh, v);
    if (sides.shares({x, y})) border[{x, y}] = z;
  }
  return border;
}

// Whether all posts of borders that have heights and void neighbours are vertices.
bool parts_voids(const TilePosts& posts, const TileSides& sides, const SharedVertices& border) {
  bool parts = true;
  for_each_post(posts.tile(), [&](int64_t x, int64_t y, int64_t z) {
    const Point p{static_cast<uint16_t>(x), static_cast<uint16_t>(y)};
    if (z == kVoidHeight || !sides.shares(p) || border.count(p) != 0) return;
    if (posts.is_beside_void(posts.box().x + p.x, posts.box().y + p.y)) parts = false;
  });
  return parts;
}

bool is_within(const Margins& stated, const Margins& found) {
  return (stated.below == kNotStated || found.below <= stated.below) &&
         (stated.above == kNotStated || found.above <= stated.above);
}

// Whether a tile states the bounds that its posts have of their own, and no smaller errors.
bool states_bounds(const std::optional<BoundSpan>& stated, const std::optional<BoundSpan>& found) {
  if (!stated || !found) return !stated && !found;
  return stated->bounded == found->bounded && stated->unbounded == found->unbounded &&
         stated->least == found->least && stated->largest == found->largest &&
         found->ratio <= stated->ratio;
}

// Whether a tile keeps the bound between posts, if it is to hold there.
bool keeps_everywhere(const LatticeOptions& options, const microtin_mesh* mesh, const Raster& part,
                      const Placement& lattice) {
  return !is_bound_everywhere(options) || EverywhereBound(part, options, lattice).see(mesh) == 0;
}

// Whether a tile has edges along all lines.
bool keeps_lines(const TiledRaster& tiled, const TilePosts& posts, const microtin_mesh* mesh,
                 const Raster& part, const Placement& lattice) {
  if (tiled.lines == nullptr) return true;
  const std::vector<LatticeLine> lines =
      parts_of(tiled.lines->in_tile(tiled.grid, posts.box()), part);
  return !verifying::find_breaklines(mesh, lines, line_room(tiled), lattice).missing;
}

// Without a bound every post is a vertex, at the nearest step.
Decimal bound_of(const TiledRaster& tiled) {
  if (tiled.options.max_error) return *tiled.options.max_error;
  const Lattice& lattice = tiled.lattice;
  return lattice.z_decimals < kMaxDecimals
             ? make_decimal(lattice.z.step * 5, lattice.z_decimals + 1)
             : make_decimal(lattice.z.step / 2, lattice.z_decimals);
}

}  // namespace

KeptTiles::KeptTiles(const PackFile& old, const TiledRaster& changed, const Progress& progress)
    : old_(old), changed_(changed), tiles_(tile_count(changed.grid)) {
  CountedProgress done(progress, tiles_.size());
  for_each_parallel(tiles_.size(), [&](std::size_t i) {
    try {
      tiles_[i] = examined(static_cast<uint32_t>(i));
    } catch (const Error&) {  // the old tile cannot be read: it is not kept
    }
    done.add_one();
  });
}

KeptTiles::Tile KeptTiles::examined(uint32_t number) const {
  const TilePosts posts(changed_, number);
  const TileSides sides(changed_.grid, posts.box());
  std::optional<DecodedTerrain> decoded = old_.tile(number);
  if (!decoded) return {!has_own_posts(posts, sides), {}, {}};
  const Raster part = posts.tile();
  const Placement lattice = {part.x, part.y, changed_.lattice.placement.z};
  WaterGauge gauge(part.decimals, changed_.options.water_level);
  const Verification found =
      verifying::verify(decoded->mesh(), lattice, part, bound_of(changed_), gauge.visitor());
  const Margins stated = old_.margins(number);
  Tile tile;
  tile.border = border_of(decoded->mesh(), sides);
  tile.is_kept = keeps_options(changed_.options, found, gauge.moved()) &&
                 keeps_everywhere(changed_.options, decoded->mesh(), part, lattice) &&
                 keeps_lines(changed_, posts, decoded->mesh(), part, lattice) &&
                 parts_voids(posts, sides, tile.border) &&
                 states_bounds(decoded->bounds(), found.bounds) &&
                 is_within(stated, margins_of(measure_gap(decoded->mesh(), lattice, part)));
  tile.summary = summary_of(old_.stream(number), std::move(*decoded), found);
  tile.summary.below = stated.below;
  tile.summary.above = stated.above;
  return tile;
}

uint32_t KeptTiles::count() const {
  return static_cast<uint32_t>(
      std::count_if(tiles_.begin(), tiles_.end(), [](const Tile& tile) { return tile.is_kept; }));
}

EncodedTile KeptTiles::tile(uint32_t tile) const {
  return {tiles_[tile].summary, old_.stream(tile)};
}

std::optional<int16_t> KeptTiles::height_at(GlobalPost post) const {
  for (const uint32_t tile : tiles_at(changed_.grid, post)) {
    if (!keeps(tile)) continue;
    const TileBox box = tile_box(changed_.grid, tile);
    const auto vertex = border(tile).find(
        {static_cast<uint16_t>(post.x - box.x), static_cast<uint16_t>(post.y - box.y)});
    if (vertex != border(tile).end()) return vertex->second;
  }
  return std::nullopt;
}

}  // namespace microtin::pack
