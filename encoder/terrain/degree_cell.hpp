// SPDX-License-Identifier: MIT
// The cells of a degree by a degree into which SRTM and autopilots cut the world.
#ifndef MICROTIN_ENCODER_TERRAIN_DEGREE_CELL_HPP
#define MICROTIN_ENCODER_TERRAIN_DEGREE_CELL_HPP

#include <optional>
#include <string>

#include "encoder/layers.hpp"

namespace microtin::terrain {

// By its south-west corner, in whole degrees: -90 <= latitude < 90, -180 <= longitude < 180.
struct DegreeCell {
  int latitude, longitude;
};

// The cell that a file is named after, up to the first '.' or '_', such as N43E007.hgt; nothing for
// other names.
std::optional<DegreeCell> cell_of(const std::string& path);

}  // namespace microtin::terrain

#endif
