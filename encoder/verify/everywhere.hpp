// SPDX-License-Identifier: MIT
// How far a surface of triangles is from the bilinear surface of a raster's posts.
#ifndef MICROTIN_ENCODER_VERIFY_EVERYWHERE_HPP
#define MICROTIN_ENCODER_VERIFY_EVERYWHERE_HPP

#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"
#include "encoder/verify/verify.hpp"

namespace microtin::verifying {

// The largest distances of a surface below and above another, in units of 2^-16 z steps, rounded
// up.
struct Gap {
  Wide below, above;
};

// Compares at the posts, where they lie, and along the edges of all real triangles. A bilinear less
// a linear function has no extreme inside the part of a triangle that lies in a cell, and along a
// line between posts it is linear. So these are the largest distances everywhere. Cells with a void
// post are left out, and so is what lies outside the grid of posts. Nothing if the numbers of the
// two lattices are too large for exact arithmetic, or if the raster is sparse. Takes O(posts +
// edges x cells that an edge crosses).
std::optional<Gap> measure_gap(const microtin_mesh* mesh, const Placement& lattice,
                               const Raster& raster);

enum class Side : uint8_t { kBelow, kAbove };

// How far the surface is beyond the bilinear one, on that side of it, in Gap's units, rounded up:
// the most at each post and in the cells around it; 0: nowhere. Otherwise as measure_gap.
std::optional<std::vector<int64_t>> beyond(const microtin_mesh* mesh, const Placement& lattice,
                                           const Raster& raster, Side side);

// Measures these distances in the unit of heights.
std::optional<Distances> measure_everywhere(const microtin_mesh* mesh, const Placement& lattice,
                                            const Raster& raster);

// As a header states them, rounded up. Not stated where nothing was measured, or too much.
Margins margins_of(const std::optional<Gap>& gap);

// What a header states, in the unit of heights, rounded up at 9 decimals.
std::optional<Distances> stated_everywhere(const Margins& margins, const Axis& z);

}  // namespace microtin::verifying

#endif
