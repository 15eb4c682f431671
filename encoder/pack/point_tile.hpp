// SPDX-License-Identifier: MIT
// One tile of a cloud of points: its survey and its stream.
#ifndef MICROTIN_ENCODER_PACK_POINT_TILE_HPP
#define MICROTIN_ENCODER_PACK_POINT_TILE_HPP

#include <cstdint>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/pack/point_borders.hpp"
#include "encoder/pack/tile.hpp"
#include "encoder/pack/tile_contents.hpp"

namespace microtin::pack {

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
  // does not keep what was asked for.
  EncodedTile encode(uint32_t tile, const std::vector<uint32_t>& points) const;

 private:
  const TiledCloud& tiled_;
  const PointBorders& borders_;
  TileContents samples_;
};

}  // namespace microtin::pack

#endif
