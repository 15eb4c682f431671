// SPDX-License-Identifier: MIT
// Points that are the posts of a raster.
#ifndef MICROTIN_ENCODER_TERRAIN_GRIDDED_HPP
#define MICROTIN_ENCODER_TERRAIN_GRIDDED_HPP

#include <optional>
#include <string>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::terrain {

// The raster whose posts the points are: rows and columns of equal distances, at least three of
// each, of which points take at least half, each another post; the rest is void. Nothing if there
// is none. O(n).
std::optional<Raster> gridded(const PointCloud& cloud);

// A sentence that says so, with the remedy; empty if the points are no such raster.
std::string warning_on_grid(const PointCloud& cloud);

}  // namespace microtin::terrain

#endif
