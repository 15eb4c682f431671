// SPDX-License-Identifier: MIT
// Queries of a stream's or a pack's surface at real places: heights of its exact plane, slopes,
// heights of areas, and profiles. Each has a source of its own, but heights and slopes have one.
#ifndef MICROTIN_ENCODER_EXPORT_QUERIES_HPP
#define MICROTIN_ENCODER_EXPORT_QUERIES_HPP

#include <cstdint>
#include <functional>
#include <optional>

#include "encoder/exact/units.hpp"
#include "encoder/layers.hpp"
#include "encoder/pack/file.hpp"
#include "encoder/terrain/exact_query.hpp"
#include "microtin/profile.hpp"

namespace microtin::exporting {

// A position in the surface's coordinates.
struct Position {
  double x, y;
};

// The mesh of a tile, until the next tile is requested; null if there is none.
struct TileMesh {
  const microtin_mesh* mesh;
  microtin_query_result absent;  // why the tile has no height beyond the mesh
};

// A surface that can be sampled. Lattice numbers; they count from the pack's first post.
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

// Decodes tiles when they are needed and keeps as many as two rows have, those used last; fewer,
// but four, if they have more vertices together than `kept_vertices`. The pack must outlive it.
SampledSurface sampled(const PackFile& pack, BadTiles bad_tiles = BadTiles::kThrow,
                       uint64_t kept_vertices = kMaxVertices);

// Where the last search ended; the next one is quick if it is near.
struct GradientSearch {
  const microtin_mesh* mesh = nullptr;
  uint32_t hint = 0;
};

// z steps for each lattice step.
struct LatticeGradient {
  double x, y;
};

// The gradient of the exact triangle at a place. On an edge or a vertex it is that of the triangle
// that devices choose: see microtin_mesh_gradient_at. Nothing if the place has no height, or only
// as a vertex among voids. Throws Error as the surface's height_at does.
std::optional<LatticeGradient> gradient_at(const SampledSurface& surface, const RealPlace& place,
                                           GradientSearch& search);

// Heights of a tile's vertices; z steps.
struct TileHeights {
  bool has_terrain;
  int32_t lowest, highest;
};

// The heights of the tiles that an area touches.
struct AreaHeights {
  bool is_complete = true;  // the area is inside, and all of them have terrain
  bool has_terrain = false;
  int32_t lowest = 0, highest = 0;
};

using TileHeightsOf = std::function<TileHeights(uint32_t tile)>;

// The area is a box, of which two opposite corners are given, or the straight line between two
// positions. A tile that comes within 1/256 of a lattice step counts, too, so that no rounding
// leaves one out. Throws Error if a position is not a number. O(rows of tiles + tiles touched).
AreaHeights heights_in_box(const SampledSurface& surface, const TileHeightsOf& heights_of,
                           Position corner, Position opposite);
AreaHeights heights_on_line(const SampledSurface& surface, const TileHeightsOf& heights_of,
                            Position from, Position to);

// The profile of the straight line between two positions. Degrees that differ by a turn are one
// place, and the line takes the shorter way. The decoder walks along the line, tile by tile. The
// line bends at borders of tiles and of the lattice, by at most 1/512 of a lattice step. A tile
// that cannot be read is a part of the line that is not known. Throws Error if a position is not a
// number, or 2^32 lattice steps away.
encoder::Profile profile_of(const SampledSurface& surface, Unit horizontal, Unit vertical,
                            Position from, Position to);

}  // namespace microtin::exporting

#endif
