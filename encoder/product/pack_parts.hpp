// SPDX-License-Identifier: MIT
// Parts of packs: whole tiles are taken out, and put together again, without encoding.
#ifndef MICROTIN_ENCODER_PRODUCT_PACK_PARTS_HPP
#define MICROTIN_ENCODER_PRODUCT_PACK_PARTS_HPP

#include <string>
#include <vector>

#include "encoder/export/grid.hpp"
#include "encoder/files/output.hpp"
#include "encoder/layers.hpp"
#include "encoder/pack/file.hpp"
#include "encoder/product/encode_pack.hpp"

namespace microtin::product {

// The tiles of a pack that have a place in the extent, as a pack of their own; where tiles have an
// odd width or height, one more column or row in the west or south may be needed. Streams stay as
// they are; errors are those that the whole pack states. Decodes each tile. Throws Error naming the
// pack, also if it has no tile there.
PackContent cut_pack(const std::string& path, const Extent& extent, StreamSpool& streams);

// Packs that were cut from one, or from packs of one plan, as one pack. Tiles in several of them
// must be the same; tiles in none have no terrain. Throws Error naming the pack that does not go
// with the first, also if borders differ.
PackContent join_packs(const std::vector<std::string>& paths, StreamSpool& streams);

}  // namespace microtin::product

#endif
