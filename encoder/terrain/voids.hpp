// SPDX-License-Identifier: MIT
// Filling gaps of a raster.
#ifndef MICROTIN_ENCODER_TERRAIN_VOIDS_HPP
#define MICROTIN_ENCODER_TERRAIN_VOIDS_HPP

#include "encoder/layers.hpp"
#include "encoder/terrain/crop.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::terrain {

// Fills the void regions (connected by sides) of up to `largest` posts with heights whose every one
// is the mean of its four neighbours, like a soap film on the region's rim. Counts
// them as filled.
void fill_voids(Raster& raster, uint32_t largest);

struct Sides {
  bool west, south, east, north;
};

// Whether a void region of up to `largest` posts goes from the inner rectangle to one of these
// sides of the raster.
bool reaches_side(const Raster& raster, const PostRectangle& inner, Sides sides, uint32_t largest);

}  // namespace microtin::terrain

#endif
