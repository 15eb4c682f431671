// SPDX-License-Identifier: MIT
// Between which heights an area lies, by what is known of tiles without their vertices.
#ifndef MICROTIN_ENCODER_EXPORT_HEIGHT_BOUNDS_HPP
#define MICROTIN_ENCODER_EXPORT_HEIGHT_BOUNDS_HPP

#include <cstdint>
#include <functional>

#include "encoder/export/height_sampler.hpp"
#include "encoder/export/profile.hpp"
#include "encoder/layers.hpp"

namespace microtin::exporting {

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

}  // namespace microtin::exporting

#endif
