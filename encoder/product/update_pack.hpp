// SPDX-License-Identifier: MIT
// Brings a pack up to date with a terrain that changed.
#ifndef MICROTIN_ENCODER_PRODUCT_UPDATE_PACK_HPP
#define MICROTIN_ENCODER_PRODUCT_UPDATE_PACK_HPP

#include <cstdint>
#include <optional>
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

// The max_error for which the map of a pack's bounds holds as it is; nothing if its posts have no
// bounds of their own. Throws Error naming the pack.
std::optional<Decimal> max_error_of_map(const std::string& pack);

// Keeps the tiles that do for the changed raster all that the old pack states, and encodes the
// others by the bound, side, water level, lattice and coding of the old pack. Borders between new
// tiles and kept ones stay. Reads the raster twice.
//
// `bound_at`: whether the bound is kept between posts, too. If it is nothing, it is kept there if
// the old pack shows that it is: over obstacles, and if its margins are within the bound.
//
// The options set the notes, the search and `tile_vertices` alone. A new tile has at most
// `tile_vertices` vertices. If that is 0, a new tile has no more vertices, and no more bytes in
// compact form, than the old pack states for any tile: devices that hold the old tiles hold it.
//
// Throws Error naming the old pack if its header is wrong, if its index is cut off, or if its tiles
// are not a raster's. Throws Error if the raster has other posts, units or systems, if its heights
// are beyond the lattice, if a new tile is too large, or if an option is for streams.
UpdatedPack update_pack(const std::string& old, const RasterReader& raster,
                        const EncodeOptions& options, std::optional<BoundScope> bound_at,
                        StreamSpool& streams, const Progress& progress);

}  // namespace microtin::product

#endif
