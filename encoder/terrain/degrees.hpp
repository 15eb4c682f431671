// SPDX-License-Identifier: MIT
// Places in degrees: which there are on Earth, and the cells of a degree by a degree.
#ifndef MICROTIN_ENCODER_TERRAIN_DEGREES_HPP
#define MICROTIN_ENCODER_TERRAIN_DEGREES_HPP

#include <optional>
#include <string>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::terrain {

constexpr double kPi = 3.14159265358979323846;

// "latitude 158.2 is beyond 90 degrees", or empty: longitudes, of axis 0, go up to 360 degrees to
// either side, latitudes, of axis 1, up to 90.
std::string beyond_degrees(size_t axis, Decimal value);

// Throws Error, naming the place, if a terrain in degrees has one that there is not. Of a raster
// those of its posts count, not the outer halves of cells; writers may round corners by a hundredth
// of a cell, and a longitude may be that of the column behind 360.
void expect_on_earth(const PointCloud& cloud);
void expect_on_earth(const Raster& frame);

// By its south-west corner, in whole degrees: -90 <= latitude < 90, -180 <= longitude < 180.
struct DegreeCell {
  int latitude, longitude;
};

// The cell that a file is named after, up to the first '.' or '_', such as N43E007.hgt; nothing for
// other names.
std::optional<DegreeCell> cell_of(const std::string& path);

}  // namespace microtin::terrain

#endif
