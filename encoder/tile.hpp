// One tile of a raster: its survey, its stream, and what it keeps of what was asked for.
#ifndef MICROTIN_ENCODER_TILE_HPP
#define MICROTIN_ENCODER_TILE_HPP

#include <cstdint>
#include <vector>

#include "encoder/borders.hpp"
#include "encoder/simplify.hpp"
#include "encoder/verify.hpp"

namespace microtin {

// Which places of a tile others have, too.
class Sides {
 public:
  Sides(const TileGrid& grid, const TileBox& box)
      : box_(box), x_max_(grid.x_max), y_max_(grid.y_max) {}

  bool shares(Point p) const {
    const uint32_t x = box_.x + p.x, y = box_.y + p.y;
    return (x == box_.x && x != 0) || (x == box_.x_end && x != x_max_) || (y == box_.y && y != 0) ||
           (y == box_.y_end && y != y_max_);
  }

 private:
  TileBox box_;
  uint32_t x_max_, y_max_;
};

// Whether not all samples, which are in lexicographic order, lie on one line.
bool form_triangle(const std::vector<Sample>& samples);

// The posts of a tile. On borders with other tiles the shared vertices stand for all posts with
// heights: they are fixed.
Survey survey_of_tile(const TiledRaster& tiled, uint32_t tile, const SharedVertices& shared);

// Whether a stream can hold it: its samples form a triangle. Throws Error if not and posts of it
// lie on no border, so that no other tile holds them.
bool has_terrain(const TiledRaster& tiled, uint32_t tile, const Survey& survey);

// The posts of a box that have heights, but not in its mesh; without a mesh all.
std::vector<GlobalPost> uncovered_posts(const microtin_mesh* mesh, const Raster& part,
                                        const TileBox& box);

struct EncodedTile {
  std::vector<uint8_t> stream;  // none: the tile has no terrain
  uint32_t vertices = 0;
  int16_t lowest = 0, highest = 0;    // of them
  Verification measured;              // by the decoded stream
  std::vector<GlobalPost> uncovered;  // on borders with other tiles
};

// Sets vertices, lowest and highest.
void add_heights(const Tin& tin, EncodedTile& tile);

// Throws Error unless the vertices on borders are the shared ones, at their heights.
void check_shared(const microtin_mesh* mesh, const Sides& sides, const SharedVertices& shared);

// Throws Error if the decoded stream does not keep the bound or the shared vertices.
EncodedTile encode_tile(const TiledRaster& tiled, uint32_t tile, const SharedVertices& shared,
                        const SimplifyOptions& options);

}  // namespace microtin

#endif
