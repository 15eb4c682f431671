// SPDX-License-Identifier: MIT
// One tile of a cloud of points: what lies in it, its survey and its stream.
#ifndef MICROTIN_ENCODER_PACK_POINT_TILE_HPP
#define MICROTIN_ENCODER_PACK_POINT_TILE_HPP

#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/pack/borders.hpp"
#include "encoder/pack/point_borders.hpp"
#include "encoder/pack/tile.hpp"

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

// A cloud that is cut into tiles.
struct TiledCloud {
  const PointCloud& cloud;
  const PointSurvey& survey;
  const GlobalTriangulation& triangulation;  // of the places of the samples
  LatticeOptions lattice;
  SimplifyOptions simplify;
  BorderTolerance tolerance;
  TileGrid grid;
};

class PointTiles {
 public:
  // Both must outlive this.
  PointTiles(const TiledCloud& tiled, const PointBorders& borders);

  // The samples inside a tile and, as fixed ones, the vertices that it shares.
  Survey survey_of(uint32_t tile) const;

  // The vertices that it takes with such options, 0 if it has no terrain.
  uint32_t vertices_of(uint32_t tile, const SimplifyOptions& options) const;

  // Encodes it, given the numbers of the points that lie in it. Throws Error if the decoded stream
  // does not meet the options.
  EncodedTile encode(uint32_t tile, const std::vector<uint32_t>& points) const;

 private:
  const TiledCloud& tiled_;
  const PointBorders& borders_;
  TileContents samples_;
};

}  // namespace microtin::pack

#endif
