// SPDX-License-Identifier: MIT
// How large tiles may be.
#ifndef MICROTIN_ENCODER_PACK_TILE_PLAN_HPP
#define MICROTIN_ENCODER_PACK_TILE_PLAN_HPP

#include <cstdint>

#include "encoder/fit/simplify.hpp"
#include "encoder/layers.hpp"
#include "encoder/pack/borders.hpp"
#include "encoder/pack/encode.hpp"

namespace microtin::pack {

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

// Tiles that a device keeps: as many as meet at a corner, unless more are asked for.
constexpr uint32_t kKeptTiles = 4;

// Vertices of a tile for which a device with this many bytes of RAM decodes one tile and keeps some
// in compact form, with 16-bit numbers. Narrow: tiles are less than 256 steps wide and high. 0 if
// there are none.
uint32_t vertices_for_ram(uint64_t bytes, bool is_narrow, uint32_t kept_tiles = kKeptTiles);

// The bytes that such a device needs, with 32-bit numbers beyond the reach of the others.
uint64_t pack_ram(uint32_t vertices, uint64_t tile_bytes, uint32_t kept_tiles = kKeptTiles);

}  // namespace microtin::pack

#endif
