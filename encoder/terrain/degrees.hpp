// SPDX-License-Identifier: MIT
// Which places in degrees there are on Earth: every door asks here.
#ifndef MICROTIN_ENCODER_TERRAIN_DEGREES_HPP
#define MICROTIN_ENCODER_TERRAIN_DEGREES_HPP

#include <string>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::terrain {

// "latitude 158.2 is beyond 90 degrees", or empty: longitudes, of axis 0, go up to 360 degrees to
// either side, latitudes, of axis 1, up to 90.
std::string beyond_degrees(size_t axis, Decimal value);

// Throws Error, naming the place, if a terrain in degrees has one that there is not. Of a raster
// those of its posts count, not the outer halves of cells; writers may round corners by a hundredth
// of a cell, and a longitude may be that of the column behind 360.
void expect_on_earth(const PointCloud& cloud);
void expect_on_earth(const Raster& frame);

}  // namespace microtin::terrain

#endif
