// SPDX-License-Identifier: MIT
// Profiles of a stream's or a pack's surface.
#ifndef MICROTIN_ENCODER_EXPORT_PROFILE_HPP
#define MICROTIN_ENCODER_EXPORT_PROFILE_HPP

#include "encoder/exact/units.hpp"
#include "encoder/export/height_sampler.hpp"
#include "encoder/layers.hpp"
#include "microtin/profile.hpp"

namespace microtin::exporting {

// A position in the surface's coordinates.
struct Position {
  double x, y;
};

// The profile of the straight line between two positions. Degrees that differ by a turn are one
// place, and the line takes the shorter way. The decoder walks along the line, tile by tile. The
// line bends at borders of tiles and of the lattice, by at most 1/512 of a lattice step. A tile
// that cannot be read is a part of the line that is not known. Throws Error if a position is not a
// number, or 2^32 lattice steps away.
encoder::Profile profile_of(const SampledSurface& surface, Unit horizontal, Unit vertical,
                            Position from, Position to);

}  // namespace microtin::exporting

#endif
