// How large tiles may be.
#ifndef MICROTIN_ENCODER_TILE_PLAN_HPP
#define MICROTIN_ENCODER_TILE_PLAN_HPP

#include <cstdint>

#include "encoder/borders.hpp"
#include "encoder/simplify.hpp"

namespace microtin {

// A raster in about `pieces` tiles along its longer side, all of nearly the same size.
TileGrid grid_of(const Raster& raster, uint32_t pieces);

// The same for any largest x and y.
TileGrid grid_of(uint32_t x_max, uint32_t y_max, uint32_t pieces);

// The fewest pieces found with which no tile has more than max_vertices vertices; at least
// `fewest`. Simplifies the raster two or three times, without searching long. Throws Error if there
// are none.
uint32_t choose_pieces(TiledRaster tiled, uint32_t max_vertices, SimplifyOptions options,
                       uint32_t fewest);

// Vertices of a tile for which a device with so many bytes of RAM decodes one tile and keeps four,
// as many as meet at a corner, with 16-bit numbers. 0 if there are none.
uint32_t vertices_for_ram(uint64_t bytes);

}  // namespace microtin

#endif
