// SPDX-License-Identifier: MIT
// Water, where the user says that it is.
#ifndef MICROTIN_ENCODER_TERRAIN_WATER_HPP
#define MICROTIN_ENCODER_TERRAIN_WATER_HPP

#include <optional>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::terrain {

// Gives void posts the height of the water level: all, or those where the mask is 1. Posts with
// heights keep them. Counts those as flooded. Throws Error if the level needs more decimals than
// go with the heights.
void flood_voids(Raster& raster, Decimal level, const Raster* mask);

// Throws Error if the mask has not the posts of the raster, or holds anything but 0, 1 and voids.
void check_water_mask(const Raster& mask, const Raster& raster);

}  // namespace microtin::terrain

#endif
