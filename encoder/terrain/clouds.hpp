// SPDX-License-Identifier: MIT
// What the points of a cloud are: some share a place of the lattice, some are a raster.
#ifndef MICROTIN_ENCODER_TERRAIN_CLOUDS_HPP
#define MICROTIN_ENCODER_TERRAIN_CLOUDS_HPP

#include <optional>
#include <string>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::terrain {

// The points that stand for all at their places of the lattice: the lowest or the highest (of equal
// ones the first), or one at the mean of their coordinates, rounded to the source's decimals.
// Nothing if the rule keeps all points, as the middle does, or no two share a place.
std::optional<PointCloud> thinned(const PointCloud& cloud, const Placement& lattice,
                                  DuplicateRule rule);

// Points that are the posts of a raster.

// The raster whose posts the points are: rows and columns of equal distances, at least three of
// each, of which points take at least half, each another post; the rest is void. Nothing if there
// is none. O(n).
std::optional<Raster> gridded(const PointCloud& cloud);

// A sentence that says so, with the remedy; empty if the points are no such raster.
std::string warning_on_grid(const PointCloud& cloud);

}  // namespace microtin::terrain

#endif
