// SPDX-License-Identifier: MIT
// Points that share a place of the lattice.
#ifndef MICROTIN_ENCODER_TERRAIN_DUPLICATES_HPP
#define MICROTIN_ENCODER_TERRAIN_DUPLICATES_HPP

#include <optional>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::terrain {

// The points that stand for all at their places of the lattice: the lowest or the highest (of equal
// ones the first), or one at the mean of their coordinates, rounded to the source's decimals.
// Nothing if the rule keeps all points, as the middle does, or no two share a place.
std::optional<PointCloud> thinned(const PointCloud& cloud, const Placement& lattice,
                                  DuplicateRule rule);

}  // namespace microtin::terrain

#endif
