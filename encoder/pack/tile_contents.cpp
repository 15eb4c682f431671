// SPDX-License-Identifier: MIT
// Sorts things by the tiles that hold them: counting sort.
#include "encoder/pack/tile_contents.hpp"

namespace microtin::pack {
namespace {

template <class Visit>
void visit_tiles(const TileGrid& grid, GlobalPost place, const Visit& visit) {
  if (place.x > grid.x_max || place.y > grid.y_max) return;
  for (const uint32_t tile : tiles_at(grid, place)) visit(tile);
}

}  // namespace

TileContents::TileContents(const TileGrid& grid, const std::vector<GlobalPost>& places)
    : start_(tile_count(grid) + 1) {
  for (const GlobalPost place : places) {
    visit_tiles(grid, place, [&](uint32_t tile) { ++start_[std::size_t{tile} + 1]; });
  }
  for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
  numbers_.resize(static_cast<std::size_t>(start_.back()));
  std::vector<std::ptrdiff_t> next(start_);
  for (std::size_t i = 0; i < places.size(); ++i) {
    visit_tiles(grid, places[i], [&](uint32_t tile) {
      numbers_[static_cast<std::size_t>(next[tile]++)] = static_cast<uint32_t>(i);
    });
  }
}

}  // namespace microtin::pack
