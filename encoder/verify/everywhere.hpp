// SPDX-License-Identifier: MIT
// How far a surface of triangles is from the bilinear surface of a raster's posts.
#ifndef MICROTIN_ENCODER_VERIFY_EVERYWHERE_HPP
#define MICROTIN_ENCODER_VERIFY_EVERYWHERE_HPP

#include <cstddef>
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

// How far a surface may be from the bilinear one, in Gap's units: at each post, and in a cell as
// far as at the post of its four where that is farthest.
struct Allowed {
  std::vector<int64_t> distances;  // of posts
  bool never_below = false;        // but never below it
};
int64_t allowed_in_cell(const Allowed& allowed, std::size_t post, std::size_t width);

// By how much a surface is farther below or above than allowed, at most, at a post and in the cells
// around it. In Gap's units, rounded up; 0: it is not.
struct Excess {
  int64_t below = 0, above = 0;
};

// Measures it at all posts, as measure_gap does.
std::optional<std::vector<Excess>> measure_excess(const microtin_mesh* mesh,
                                                  const Placement& lattice, const Raster& raster,
                                                  const Allowed& allowed);

// Measures these distances in the unit of heights.
std::optional<Distances> measure_everywhere(const microtin_mesh* mesh, const Placement& lattice,
                                            const Raster& raster);

// As a header states them, rounded up. Not stated where nothing was measured, or too much.
Margins margins_of(const std::optional<Gap>& gap);

// What a header states, in the unit of heights, rounded up at 9 decimals.
std::optional<Distances> stated_everywhere(const Margins& margins, const Axis& z);

}  // namespace microtin::verifying

#endif
