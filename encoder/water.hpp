// Water, where the user says that it is.
#ifndef MICROTIN_ENCODER_WATER_HPP
#define MICROTIN_ENCODER_WATER_HPP

#include "encoder/source.hpp"

namespace microtin {

// Gives void posts the height of the water level: all, or those where the mask is 1. Posts with
// heights keep them. Returns how many it gave. Throws Error if the level needs more decimals than
// go beside the heights.
uint32_t flood_voids(Raster& raster, Decimal level, const Raster* mask);

// Throws Error if the mask has not the posts of the raster, or holds anything but 0, 1 and voids.
void check_water_mask(const Raster& mask, const Raster& raster);

}  // namespace microtin

#endif
