// One tile of a raster: its survey, its stream, and what it keeps of what was asked for.
#ifndef MICROTIN_ENCODER_TILE_HPP
#define MICROTIN_ENCODER_TILE_HPP

#include <cstdint>
#include <vector>

#include "encoder/borders.hpp"
#include "encoder/simplify.hpp"
#include "encoder/verify.hpp"

namespace microtin {

// What a pack says of a tile beside its stream.
struct TileSummary {
  uint32_t bytes = 0;  // of the stream; 0: the tile has no terrain
  uint32_t stream_hash = 0;
  uint32_t vertices = 0;
  int16_t lowest = 0, highest = 0;  // of them
  Verification measured;            // by the decoded stream
};

struct EncodedTile {
  TileSummary summary;
  std::vector<uint8_t> stream;
};

// The posts of a box that have heights, but not in its mesh; without a mesh all.
std::vector<GlobalPost> uncovered_posts(const microtin_mesh* mesh, const Raster& part,
                                        const TileBox& box);

// How many vertices a tile takes; 0 without terrain. Throws Error as encode_tile does.
uint32_t count_vertices(const TiledRaster& tiled, uint32_t tile, const SimplifyOptions& options);

// Depends on the posts of the tile and those beside it alone, or, if it has no terrain, on those of
// its neighbours. A tile covers all its posts that have heights; if they form no triangle, each of
// them is another tile's, too, that does. Throws Error if there is none, or if the decoded stream
// does not keep the bound or the shared vertices.
EncodedTile encode_tile(const TiledRaster& tiled, uint32_t tile, const SimplifyOptions& options);

}  // namespace microtin

#endif
