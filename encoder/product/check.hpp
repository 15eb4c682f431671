// SPDX-License-Identifier: MIT
// What is damaged in a file, and how two packs differ; no source is needed.
#ifndef MICROTIN_ENCODER_PRODUCT_CHECK_HPP
#define MICROTIN_ENCODER_PRODUCT_CHECK_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/pack/file.hpp"

namespace microtin::product {

struct Checked {
  uint32_t tiles = 0;  // of a pack; 0: a stream
  std::vector<TileFault> faults;
};

// Decodes all of a stream, or all tiles of a pack. Throws Error naming the file if it is a stream
// that is damaged, or a pack whose header is wrong or whose index is cut off.
Checked check_file(const std::string& path);

struct Difference {
  uint32_t tiles = 0;
  bool is_header_same = false;   // placement and notes, too
  std::vector<uint32_t> differ;  // the tiles of which bytes differ
};

// Throws Error naming a file that is no pack, or is damaged; or both, if they have other tiles or
// another lattice.
Difference compare_packs(const std::string& first, const std::string& second);

}  // namespace microtin::product

#endif
