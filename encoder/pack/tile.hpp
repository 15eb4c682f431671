// SPDX-License-Identifier: MIT
// One tile of a raster: its survey, its stream, and what it keeps of what was requested.
#ifndef MICROTIN_ENCODER_PACK_TILE_HPP
#define MICROTIN_ENCODER_PACK_TILE_HPP

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "encoder/fit/simplify.hpp"
#include "encoder/layers.hpp"
#include "encoder/pack/borders.hpp"
#include "encoder/stream/device_memory.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/verify/verify.hpp"

namespace microtin::pack {

// A step from a side of a tile into it.
struct Inwards {
  int x, y;
};

// Which places of a tile others have, too.
class TileSides {
 public:
  TileSides(const TileGrid& grid, const TileBox& box)
      : box_(box), x_max_(grid.x_max), y_max_(grid.y_max) {}

  bool shares(Point p) const { return is_within(p, 0); }

  // From the sides that a place lies on and that other tiles have, too.
  std::vector<Inwards> inwards(Point p) const {
    const uint32_t x = box_.x + p.x, y = box_.y + p.y;
    std::vector<Inwards> all;
    if (x == box_.x && x != 0) all.push_back({1, 0});
    if (x == box_.x_end && x != x_max_) all.push_back({-1, 0});
    if (y == box_.y && y != 0) all.push_back({0, 1});
    if (y == box_.y_end && y != y_max_) all.push_back({0, -1});
    return all;
  }

  // Whether it is one step from such a place, or is one.
  bool is_beside(Point p) const { return is_within(p, 1); }

 private:
  bool is_within(Point p, uint32_t reach) const {
    const uint32_t x = box_.x + p.x, y = box_.y + p.y;
    return (x <= box_.x + reach && box_.x != 0) ||
           (x + reach >= box_.x_end && box_.x_end != x_max_) ||
           (y <= box_.y + reach && box_.y != 0) ||
           (y + reach >= box_.y_end && box_.y_end != y_max_);
  }

  TileBox box_;
  uint32_t x_max_, y_max_;
};

// Throws an InternalFault: a decoded tile does what it must not.
[[noreturn]] void fail_tile(const std::string& what);

// Whether not all samples, which are in lexicographic order, lie on one line.
bool form_triangle(const std::vector<Sample>& samples);

// What a pack contains of a tile in addition to its stream.
struct TileSummary {
  uint32_t bytes = 0;   // of the stream; 0: the tile has no terrain
  uint64_t offset = 0;  // of the stream among those of the pack, once they are put together
  uint32_t stream_hash = 0;
  uint32_t vertices = 0;
  int16_t lowest = 0, highest = 0;                  // of them
  uint32_t below = kNotStated, above = kNotStated;  // margins, as Contract has them
  Verification measured;                            // by the decoded stream
  std::optional<CompactForm> compact;
};

struct EncodedTile {
  TileSummary summary;
  std::vector<uint8_t> stream;
};

// The summary of a tile that is verified, but for its margins.
TileSummary summary_of(const std::vector<uint8_t>& stream, DecodedTerrain&& decoded,
                       const Verification& measured);

// Whether a tile covers its samples, and no void post, as the options say.
bool keeps_options(const LatticeOptions& options, const Verification& measured,
                   uint64_t water_moved);

// Throws Error unless the vertices on borders are the shared ones, at their heights.
void check_shared(const microtin_mesh* mesh, const TileSides& sides, const SharedVertices& shared);

// The origin of the tile's stream in the pack.
inline Origin origin_of(const TileBox& box) {
  return {(box.x & 1) != 0, (box.y & 1) != 0};
}

// The posts of a box that have heights, but not in its mesh; without a mesh all.
std::vector<GlobalPost> uncovered_posts(const microtin_mesh* mesh, const Raster& part,
                                        const TileBox& box);

// How many vertices a tile takes; 0 without terrain. Throws Error as encode_tile does.
uint32_t count_vertices(const TiledRaster& tiled, uint32_t tile, const SimplifyOptions& options);

// Whether a tile with too many vertices may fit after Search::kLong, which leaves 4 to 8 % fewer
// than Search::kNormal: 7 % on the fractal of seed 4 within 5 m. A pack with one such tile then
// need not have smaller tiles everywhere.
inline bool long_search_may_fit(uint32_t vertices, uint32_t most, const SimplifyOptions& options) {
  constexpr uint32_t kPercentLeft = 94;
  return options.bounded && options.search == Search::kNormal &&
         uint64_t{vertices} * kPercentLeft <= uint64_t{most} * 100;
}

inline SimplifyOptions with_long_search(SimplifyOptions options) {
  options.search = Search::kLong;
  return options;
}

// Depends on the posts of the tile and those within kGroundReach alone, or, if it has no terrain,
// on those of its neighbours, and on the tiles that are kept, one of which it may be. A tile covers
// all its posts that have heights; if they form no triangle, each of them is another tile's, too,
// that does. Throws Error if there is none, or if the decoded stream does not keep the bound or the
// shared vertices.
EncodedTile encode_tile(const TiledRaster& tiled, uint32_t tile, const SimplifyOptions& options);

}  // namespace microtin::pack

#endif
