// SPDX-License-Identifier: MIT
// Heights anywhere on a stream's or a pack's surface: of its exact plane, at the real place.
#ifndef MICROTIN_ENCODER_EXPORT_HEIGHT_SAMPLER_HPP
#define MICROTIN_ENCODER_EXPORT_HEIGHT_SAMPLER_HPP

#include <cstdint>
#include <functional>

#include "encoder/layers.hpp"
#include "encoder/pack/file.hpp"
#include "encoder/terrain/exact_query.hpp"

namespace microtin::exporting {

// The mesh of a tile, until the next tile is asked for; null if there is none.
struct TileMesh {
  const microtin_mesh* mesh;
  microtin_query_result absent;  // why the tile has no height beyond the mesh
};

// A surface that can be asked. Lattice numbers; they count from the pack's first post.
struct SampledSurface {
  Placement placement;
  TileGrid tiles{kLatticeMax, kLatticeMax, kLatticeMax, kLatticeMax};  // of a stream one
  int64_t x_min = 0, y_min = 0, x_max = 0, y_max = 0;                  // the box that holds it
  int32_t lowest = 0, highest = 0;                                     // vertex
  bool is_degrees = false;  // places whose x is 360 more or less are the same
  // The exact height at a place, HEIGHT, or OUTSIDE, IN_VOID or IN_BAD_TILE. Quick anywhere,
  // quickest near the place before.
  std::function<ExactAnswer(const RealPlace& place)> height_at;
  std::function<TileMesh(uint32_t tile)> mesh_of;
};

// The tiles of a row, or of a column, that have a coordinate on it: one or, on a border, two.
struct TileSpan {
  uint32_t first, last;
};
TileSpan tiles_with(int64_t whole, Wide part, uint32_t side, uint32_t count);

// The mesh must outlive it.
SampledSurface sampled(const microtin_mesh* mesh);

// What becomes of a tile that cannot be read: Error is thrown as by PackFile::tile, or its places
// are answered IN_BAD_TILE.
enum class BadTiles : uint8_t { kThrow, kAnswer };

// Decodes tiles when they are asked and keeps as many as two rows have, those asked last; fewer,
// but four, if they have more vertices together than `kept_vertices`. The pack must outlive it.
SampledSurface sampled(const PackFile& pack, BadTiles bad_tiles = BadTiles::kThrow,
                       uint64_t kept_vertices = kMaxVertices);

}  // namespace microtin::exporting

#endif
