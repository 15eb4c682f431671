// SPDX-License-Identifier: MIT
// Brings a pack up to date with a terrain that changed.
#ifndef MICROTIN_ENCODER_PRODUCT_UPDATE_PACK_HPP
#define MICROTIN_ENCODER_PRODUCT_UPDATE_PACK_HPP

#include <cstdint>
#include <string>

#include "encoder/base/progress.hpp"
#include "encoder/files/output.hpp"
#include "encoder/layers.hpp"
#include "encoder/pack/file.hpp"
#include "encoder/product/options.hpp"
#include "encoder/terrain/raster_reader.hpp"

namespace microtin::product {

struct UpdatedPack {
  PackContent content;
  uint32_t kept;  // tiles of which the bytes are the old ones
};

// Keeps the tiles that do for the changed raster all that the old pack states, and encodes the
// others by the bound, side, water level, lattice and coding of the old pack; their borders with
// tiles that are kept stay. Of the options it takes the notes, the search, and tile_vertices: what
// a new tile may have; 0: as many, and as many bytes in compact form, as the old pack states for
// any tile, so that devices that hold its tiles hold the new ones. Reads the raster twice.
//
// Throws Error naming the old pack if its header or its index is wrong or its tiles are not a
// raster's, and Error if the raster has other posts, if its heights are beyond the lattice, or if a
// new tile is too large.
UpdatedPack update_pack(const std::string& old, const RasterReader& raster,
                        const EncodeOptions& options, StreamSpool& streams,
                        const Progress& progress);

}  // namespace microtin::product

#endif
