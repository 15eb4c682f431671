// SPDX-License-Identifier: MIT
// Packs by name, read tile by tile.
#ifndef MICROTIN_ENCODER_PRODUCT_OPEN_PACK_HPP
#define MICROTIN_ENCODER_PRODUCT_OPEN_PACK_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/pack/file.hpp"

namespace microtin::product {

struct OpenPack {
  std::vector<uint8_t> header;  // with placement, notes and check
  PackFile file;                // reads an entry of the index with the entry's tile
};

// Throws Error naming the file if it is no pack, if its header is wrong, or if its index is cut
// off.
OpenPack open_pack(const std::string& path);

}  // namespace microtin::product

#endif
