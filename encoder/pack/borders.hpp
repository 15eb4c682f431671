// SPDX-License-Identifier: MIT
// The borders between the tiles of a grid: which vertices neighbours share.
#ifndef MICROTIN_ENCODER_PACK_BORDERS_HPP
#define MICROTIN_ENCODER_PACK_BORDERS_HPP

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/terrain/lay_out.hpp"
#include "encoder/terrain/raster_reader.hpp"
#include "shared/pack_format.hpp"

namespace microtin::pack {

// A raster that is to be cut into tiles: its posts are the places of the pack.
struct TiledRaster {
  const RasterReader& raster;
  Lattice lattice;  // choose_post_lattice with the options
  LatticeOptions options;
  TileGrid grid;
};

// The posts of a tile and those within kGroundReach: all that a tile depends on.
class TilePosts {
 public:
  TilePosts(const TiledRaster& tiled, uint32_t tile);

  const TileBox& box() const { return box_; }
  Raster tile() const { return crop_of(box_); }

  // The posts from the first to the last corner of a box in global coordinates.
  Raster crop_of(const TileBox& box) const;

  // Whether one of the eight posts around this one is void.
  bool is_beside_void(uint32_t x, uint32_t y) const;

 private:
  TileBox box_;
  uint32_t x_, y_;  // of the first post
  Raster posts_;
};

// The survey of a part of the raster; places count from the part's first post.
Survey survey_of(const TiledRaster& tiled, const Raster& part);

inline std::size_t tile_count(const TileGrid& grid) {
  return std::size_t{tile_columns(grid)} * tile_rows(grid);
}

// Tiles of a pack that is made, at most. Readers take as many as the format has numbers for.
constexpr uint32_t kMostTiles = 1u << 20;

inline bool has_too_many_tiles(const TileGrid& grid) {
  return uint64_t{tile_columns(grid)} * tile_rows(grid) > kMostTiles;
}

struct GlobalPost {
  uint32_t x, y;

  bool operator<(const GlobalPost& other) const { return x != other.x ? x < other.x : y < other.y; }
};

// The tiles that hold a post: one, two at a border, four at a corner.
std::vector<uint32_t> tiles_at(const TileGrid& grid, GlobalPost post);

// Heights of vertices by their place in a tile.
using SharedVertices = std::map<Point, int16_t>;

// The vertices that a tile shares with others. They depend on the posts of its borders and those
// within kGroundReach alone, so that both sides find the same. Posts beside voids are vertices:
// voids beside a border then part it from no triangle.
SharedVertices shared_vertices(const TiledRaster& tiled, const TilePosts& posts);

}  // namespace microtin::pack

#endif
