// A raster as a pack of tiles.
#ifndef MICROTIN_ENCODER_PACK_ENCODE_HPP
#define MICROTIN_ENCODER_PACK_ENCODE_HPP

#include <cstdint>
#include <vector>

#include "encoder/tile.hpp"

namespace microtin {

struct PackOptions {
  LatticeOptions lattice;    // without an xy step
  SimplifyOptions simplify;  // without max_vertices
  uint32_t max_vertices;     // of a tile, at least kFewestTileVertices
};

constexpr uint32_t kFewestTileVertices = 16;

struct EncodedPack {
  TileGrid grid;
  Placement placement;  // of the whole
  Decimal z_step;
  std::vector<EncodedTile> tiles;  // by number
  Verification measured;           // of all; posts on borders count in each tile
};

// Cuts the raster into tiles and encodes each, on all processors; the result does not depend on
// their number. Every post with a height is covered by a tile and within the bound; every void one
// stays void; borders have no cracks. Throws Error if that cannot be done, as lay_out and simplify
// do, or if a tile holds posts that form no triangle.
EncodedPack encode_pack(const Raster& raster, const PackOptions& options);

}  // namespace microtin

#endif
