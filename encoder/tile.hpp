// One tile of a raster: its survey, its stream, and what it keeps of what was asked for.
#ifndef MICROTIN_ENCODER_TILE_HPP
#define MICROTIN_ENCODER_TILE_HPP

#include <cstdint>
#include <vector>

#include "encoder/borders.hpp"
#include "encoder/simplify.hpp"
#include "encoder/verify.hpp"

namespace microtin {

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

// Throws Error if the decoded stream does not keep the bound or the shared vertices.
EncodedTile encode_tile(const TiledRaster& tiled, uint32_t tile, const SharedVertices& shared,
                        const SimplifyOptions& options);

}  // namespace microtin

#endif
