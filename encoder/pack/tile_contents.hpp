// SPDX-License-Identifier: MIT
// What lies in which tile.
#ifndef MICROTIN_ENCODER_PACK_TILE_CONTENTS_HPP
#define MICROTIN_ENCODER_PACK_TILE_CONTENTS_HPP

#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/pack/borders.hpp"

namespace microtin::pack {

// Numbers of things by the tiles that hold their places, in each of them, in order. Things whose
// place lies outside the pack are in none.
class TileContents {
 public:
  TileContents(const TileGrid& grid, const std::vector<GlobalPost>& places);

  std::vector<uint32_t> of_tile(uint32_t tile) const {
    return {numbers_.begin() + start_[tile], numbers_.begin() + start_[std::size_t{tile} + 1]};
  }
  uint32_t size_of(uint32_t tile) const {
    return static_cast<uint32_t>(start_[std::size_t{tile} + 1] - start_[tile]);
  }

 private:
  std::vector<uint32_t> numbers_;
  std::vector<std::ptrdiff_t> start_;  // by tile, and one more
};

}  // namespace microtin::pack

#endif
