// SPDX-License-Identifier: MIT
// How far a surface of triangles is from the bilinear surface of a raster's posts.
#ifndef MICROTIN_ENCODER_TERRAIN_EVERYWHERE_HPP
#define MICROTIN_ENCODER_TERRAIN_EVERYWHERE_HPP

#include <optional>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"
#include "encoder/terrain/verify.hpp"

namespace microtin::terrain {

// Compares at the posts, where they lie, and along the edges of all real triangles. A bilinear less
// a linear function has no extreme inside the part of a triangle that lies in a cell, and along a
// line between posts it is linear. So these are the largest distances everywhere. Cells with a void
// post are left out, and so is what lies outside the grid of posts. Nothing if the numbers of the
// two lattices are too large for exact arithmetic. Takes O(posts + edges x cells that an edge
// crosses).
std::optional<Distances> measure_everywhere(const microtin_mesh* mesh, const Placement& lattice,
                                            const Raster& raster);

}  // namespace microtin::terrain

#endif
