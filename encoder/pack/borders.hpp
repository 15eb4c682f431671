// SPDX-License-Identifier: MIT
// The borders between the tiles of a grid: which vertices neighbours share.
#ifndef MICROTIN_ENCODER_PACK_BORDERS_HPP
#define MICROTIN_ENCODER_PACK_BORDERS_HPP

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "encoder/fit/error_model.hpp"
#include "encoder/layers.hpp"
#include "encoder/pack/tiled_lines.hpp"
#include "encoder/terrain/lay_out.hpp"
#include "encoder/terrain/raster_reader.hpp"
#include "encoder/terrain/survey.hpp"
#include "shared/pack_format.hpp"

namespace microtin::pack {

// How many places around one count, in each direction.
constexpr uint32_t kGroundReach = 8;

// The ground: means of the middles of a rectangle's samples.
class Ground {
 public:
  // At most 2^24 posts.
  Ground(const std::vector<Sample>& samples, uint32_t width, uint32_t height);

  // The mean of the largest square around a post, which is not void, that tells of no other ground
  // than smaller ones: means do not differ by more than `tolerance`. Where the rectangle ends, or a
  // void is, squares end. O(1).
  int32_t at(uint32_t x, uint32_t y, int64_t tolerance) const;

 private:
  struct Sum {
    int64_t heights, posts;
  };
  Sum sum(uint32_t x, uint32_t y, uint32_t reach_x, uint32_t reach_y) const;
  const Sum& corner(uint32_t x, uint32_t y) const {
    return sums_[std::size_t{y} * (width_ + 1) + x];
  }

  uint32_t width_, height_;
  std::vector<Sum> sums_;  // of all posts to the south-west of a corner
};

// The border between two tiles, from corner to corner: a chain of vertices that both will have.

// A post of the line, which runs along x or y: of its places, one coordinate ascends. Void posts
// have no sample.
struct LinePost {
  std::optional<Sample> sample;  // its place tells how far along the line it is
  bool kept = false;             // must become a vertex
  int32_t aim = 0;  // the height that is best here, within the bounds or not, as a Sample's
};

struct ChainVertex {
  uint32_t post;  // its number among the posts
  int16_t height;
};

// Few vertices whose chain passes every post within its bounds and near its aim: all posts if there
// are no bounds. Chains end at voids and at the ends of the line, where heights depend on the
// sample and the aim there alone. At most 65536 posts. O(n * the posts that a piece of the chain
// reaches).
// `price` says what a vertex is worth: squares of the bound, in sums of squared distances from
// aims.
std::vector<ChainVertex> simplify_line(const std::vector<LinePost>& posts, ErrorModel model,
                                       uint32_t price);

// The borders between the tiles of a grid: which vertices neighbours share.

class KeptTiles;

// A raster that is to be cut into tiles: its posts are the places of the pack.
struct TiledRaster {
  const RasterReader& raster;
  Lattice lattice;  // choose_post_lattice with the options, or that of the tiles that are kept
  LatticeOptions options;
  TileGrid grid;
  const KeptTiles* kept = nullptr;                    // if the raster changes and most tiles do not
  std::shared_ptr<const TiledLines> lines = nullptr;  // breaklines; the options have none
};

// The heights that the bound leaves a surface on breaklines, which need one.
inline LineRoom line_room(const TiledRaster& tiled) {
  return terrain::room_of(*tiled.options.max_error, tiled.options.never_below,
                          step_of(tiled.lattice.placement.z));
}

// The posts of a tile and those within kGroundReach, or farther if posts are not at every place:
// all that a tile depends on.
class TilePosts {
 public:
  TilePosts(const TiledRaster& tiled, uint32_t tile);

  uint32_t number() const { return number_; }
  const TileBox& box() const { return box_; }
  Raster tile() const { return crop_of(box_); }

  // The posts from the first to the last corner of a box in global coordinates.
  Raster crop_of(const TileBox& box) const;

  // Whether one of the posts next to this one, in eight directions, is void.
  bool is_beside_void(uint32_t x, uint32_t y) const;

 private:
  uint32_t number_;
  TileBox box_;
  uint32_t x_, y_;  // of the first post
  Raster posts_;
};

// The survey of a part of the raster, within the first fit's bound or by other options; places
// count from the part's first post.
Survey survey_of(const TiledRaster& tiled, const Raster& part);
Survey survey_of(const TiledRaster& tiled, const Raster& part, const LatticeOptions& options);

// A box with what is next to it, as far as the grid goes.
TileBox around(const TileGrid& grid, const TileBox& box, uint32_t reach_x, uint32_t reach_y);

// The places of a line, which is a box of one column or row.
inline uint32_t places_of(const TileBox& line) {
  return (line.x_end - line.x) + (line.y_end - line.y) + 1;
}

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
// within kGroundReach alone, so that both sides find the same. Posts next to voids are vertices:
// voids next to a border then part it from no triangle. The vertices of tiles that are kept stay.
SharedVertices shared_vertices(const TiledRaster& tiled, const TilePosts& posts);

}  // namespace microtin::pack

#endif
