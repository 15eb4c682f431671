// SPDX-License-Identifier: MIT
// The convex hull of places.
#ifndef MICROTIN_ENCODER_TERRAIN_CONVEX_HULL_HPP
#define MICROTIN_ENCODER_TERRAIN_CONVEX_HULL_HPP

#include <cstdint>
#include <vector>

#include "encoder/layers.hpp"
#include "shared/lattice.hpp"

namespace microtin::terrain {

// The numbers of the corners, counter-clockwise, without places on edges (Andrew's monotone chain).
// Places are distinct and in lexicographic order. Of places on one line the corners are its ends;
// of one place there is none. O(places).
std::vector<uint32_t> hull_corners(const std::vector<Point>& places);

}  // namespace microtin::terrain

#endif
