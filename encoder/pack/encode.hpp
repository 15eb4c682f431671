// SPDX-License-Identifier: MIT
// A raster as the tiles of a pack, and how large tiles may be. The plan has a source of its own.
#ifndef MICROTIN_ENCODER_PACK_ENCODE_HPP
#define MICROTIN_ENCODER_PACK_ENCODE_HPP

#include <cstdint>
#include <functional>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/fit/simplify.hpp"
#include "encoder/layers.hpp"
#include "encoder/pack/borders.hpp"
#include "encoder/pack/tile.hpp"
#include "encoder/terrain/raster_scan.hpp"

namespace microtin::pack {

struct PackOptions {
  LatticeOptions lattice;          // without an xy step
  SimplifyOptions simplify;        // without max_vertices
  uint32_t max_vertices;           // of a tile, at least kFewestTileVertices
  uint32_t tile_size = 0;          // extent of a tile; 0: to be chosen
  uint32_t max_vertices_wide = 0;  // of one of 256 steps or more; 0: max_vertices
};

// Whether a tile takes no more memory in compact form than macros promise for `most` vertices.
bool fits(const TileSummary& tile, uint32_t most);

// The most vertices of a tile of the grid: compact terrains take more where they are wide.
uint32_t most_vertices(const PackOptions& options, const TileGrid& grid);

constexpr uint32_t kFewestTileVertices = 16;

// What all tiles have in common: a function of the raster and the options alone.
struct PackPlan {
  TiledRaster tiled;
  PackOptions options;
  uint32_t tile_size;
  uint64_t fingerprint;  // of the raster
  double planned;        // part of all the time that planning took, estimated
};

// Chooses the step of heights by the roughest part of the raster, and the size of tiles by their
// roughest, where the options do not say. Reads the raster a few times. The raster must outlive the
// plan. Throws Error if that cannot be done, as lay_out does, or if a raster has a single row of
// posts.
PackPlan plan_pack(const RasterReader& raster, const PackOptions& options);

// The tiles numbered from `first` to `last`.
struct TileRange {
  uint32_t first, last;
};

TileRange all_tiles(const TileGrid& grid);

// A tile that has more vertices than it may.
struct TileTooLarge : Error {
  TileTooLarge(uint32_t number, uint32_t count, uint32_t steps);

  uint32_t tile, vertices;
  uint32_t fewer_steps;  // tile_size to be tried next
};

using TakeTile = std::function<void(uint32_t tile, EncodedTile&&)>;

// Encodes tiles on all processors and gives them away in the order of their numbers; they do not
// depend on the range or the number of processors. Every post with a height is covered by a tile
// and within the bound; every void one stays void; borders have no cracks. Throws Error as
// encode_tile does, and TileTooLarge.
void encode_tiles(const PackPlan& plan, TileRange range, const TakeTile& take);

// Encodes all tiles. If one is too large and no size was requested, begins again with smaller ones:
// calls begin(plan) before that, and first of all, which returns the first tile to encode.
// `tile_size`, if not 0, is tried first.
void encode_pack(const RasterReader& raster, const PackOptions& options, uint32_t tile_size,
                 const std::function<uint32_t(const PackPlan&)>& begin, const TakeTile& take);

// A raster in tiles of up to `tile_size` lattice steps a side, all of nearly the same size. Throws
// Error if a pack cannot have as many tiles.
TileGrid grid_of(const Raster& frame, uint32_t tile_size);

// The grid of tiles for any largest x and y, and for any number of tiles.
TileGrid grid_of(uint32_t x_max, uint32_t y_max, uint32_t tile_size);

// The largest tile_size found with which no tile has more vertices than it may, as far as
// the roughest tiles tell: up to 24 of them are simplified, at most five times once some fit,
// without searching long unless they are a little too large then, and the raster is read as often.
// Throws Error if there are none.
uint32_t choose_tile_size(TiledRaster tiled, const PackOptions& options, const Progress& progress);

// How much of the time of a pack that takes, estimated.
double counting_part(const Raster& frame, const PackOptions& options);

// What to try next if a tile has too many vertices; less than tile_size. Throws Error if there is
// nothing smaller.
uint32_t smaller_tile_size(const TileGrid& grid, uint32_t max_vertices, uint32_t vertices);

// Tiles that a device keeps: as many as meet at a corner, unless more are requested.
constexpr uint32_t kKeptTiles = 4;

// Vertices of a tile for which a device with this many bytes of RAM decodes one tile and keeps some
// in compact form, with 16-bit numbers. Narrow: tiles are less than 256 steps wide and high. 0 if
// there are none.
uint32_t vertices_for_ram(uint64_t bytes, bool is_narrow, uint32_t kept_tiles = kKeptTiles);

// The bytes that such a device needs, with 32-bit numbers beyond the reach of the others.
uint64_t pack_ram(uint32_t vertices, uint64_t tile_bytes, uint32_t kept_tiles = kKeptTiles);

}  // namespace microtin::pack

#endif
