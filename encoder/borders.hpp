// The borders between the tiles of a grid: which vertices neighbours share.
#ifndef MICROTIN_ENCODER_BORDERS_HPP
#define MICROTIN_ENCODER_BORDERS_HPP

#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "encoder/border_line.hpp"
#include "encoder/lay_out.hpp"
#include "shared/pack_format.hpp"

namespace microtin {

// A raster that is to be cut into tiles: its posts are the places of the pack.
struct TiledRaster {
  const Raster& raster;
  Lattice lattice;  // choose_post_lattice with the options
  LatticeOptions options;
  TileGrid grid;
};

// The posts from the first to the last corner of a box.
Raster crop(const Raster& raster, const TileBox& box);

// The survey of a part of the raster; places count from the part's first post.
Survey survey_of(const TiledRaster& tiled, const Raster& part);

struct GlobalPost {
  uint32_t x, y;

  bool operator<(const GlobalPost& other) const { return x != other.x ? x < other.x : y < other.y; }
};

// The tiles that hold a post: one, two at a border, four at a corner.
std::vector<uint32_t> tiles_at(const TileGrid& grid, GlobalPost post);

// Heights of vertices by their place in a tile.
using SharedVertices = std::map<Point, int16_t>;

class Borders {
 public:
  // Simplifies all of them. The raster must outlive this.
  explicit Borders(const TiledRaster& tiled);

  // The vertices that a tile shares with others.
  SharedVertices of_tile(uint32_t tile) const;

  // Makes posts of borders vertices and simplifies anew what they lie on. Returns the tiles whose
  // shared vertices may have changed.
  std::set<uint32_t> keep(const std::vector<GlobalPost>& posts);

 private:
  // Runs north or east from the first corner of a tile.
  struct Line {
    TileBox box;
    std::set<uint32_t> kept;  // posts from the beginning
    std::vector<ChainVertex> chain;
  };

  void simplify(Line& line) const;
  std::vector<std::size_t> lines_at(GlobalPost post) const;

  TiledRaster tiled_;
  std::vector<Line> lines_;
  std::map<GlobalPost, std::size_t> north_, east_;  // lines by their first post
};

}  // namespace microtin

#endif
