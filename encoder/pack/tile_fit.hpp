// SPDX-License-Identifier: MIT
// The surface of a tile: its posts with the vertices that its borders share, within the bound.
#ifndef MICROTIN_ENCODER_PACK_TILE_FIT_HPP
#define MICROTIN_ENCODER_PACK_TILE_FIT_HPP

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "encoder/fit/simplify.hpp"
#include "encoder/layers.hpp"
#include "encoder/pack/borders.hpp"
#include "encoder/pack/tile.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/verify/everywhere.hpp"
#include "encoder/verify/verify.hpp"

namespace microtin::pack {

// A surface for a tile, and how far it is from the tile's posts.
struct FittedTile {
  Tin tin;
  Encoding encoded;
  Verification measured;
};

// Finds the surface of a tile, from attempt to attempt.
class TileFit {
 public:
  // Both must outlive this.
  TileFit(const TiledRaster& tiled, const TilePosts& posts);
  TileFit(const TileFit&) = delete;
  TileFit& operator=(const TileFit&) = delete;

  const Raster& part() const { return part_; }
  Placement lattice() const { return {part_.x, part_.y, tiled_.lattice.placement.z}; }

  // Whether a stream can hold the tile: its samples do not lie on one line.
  bool forms_triangle() const { return form_triangle(laid_.survey.samples); }

  // Whether the tile has a triangle. Throws Error if not, and posts of the tile lie on no border,
  // so that no other tile holds them.
  bool has_terrain() const;

  // A surface that keeps the options at posts, and maybe not between them.
  Tin first(const SimplifyOptions& options) const { return simplify(laid_.survey, options); }

  // A surface that keeps all options, measured. Throws Error as encode_tile does.
  FittedTile fit(const SimplifyOptions& options);

 private:
  void add_lines();
  void expect_edges(const microtin_mesh* mesh) const;
  bool narrow(const microtin_mesh* mesh);
  std::map<Point, Tightening> limits_inside() const;
  std::vector<Point> beside_edges(Point post) const;
  bool is_inside(int64_t x, int64_t y) const {
    return x >= 0 && y >= 0 && x < part_.width && y < part_.height;
  }
  void pin_beside_borders(const std::vector<Point>& vertices, Survey& survey) const;

  const TiledRaster& tiled_;
  const TilePosts& posts_;
  TileSides sides_;
  Raster part_;
  SharedVertices shared_;
  Laid laid_;
  std::vector<LatticeLine> lines_;
  std::optional<EverywhereBound> everywhere_;
  int attempts_ = 0;
};

}  // namespace microtin::pack

#endif
