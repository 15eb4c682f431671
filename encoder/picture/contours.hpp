// SPDX-License-Identifier: MIT
// Lines of equal height on a mesh.
#ifndef MICROTIN_ENCODER_PICTURE_CONTOURS_HPP
#define MICROTIN_ENCODER_PICTURE_CONTOURS_HPP

#include <vector>

#include "encoder/export/export.hpp"
#include "encoder/layers.hpp"
#include "encoder/picture/canvas.hpp"

namespace microtin::picture {

// On the lattice; the first place is also the last one of a closed line.
struct Contour {
  int64_t level;  // times the interval
  std::vector<Spot> places;
};

constexpr int64_t kIndexContour = 5;  // each fifth one is heavier

inline bool is_index(const Contour& contour) {
  return contour.level % kIndexContour == 0;
}

// A 1, 2 or 5 times a power of ten that gives 10 to 25 lines between these heights; nothing if
// there are no two.
std::optional<Decimal> round_interval(double low, double high);

// Where the triangles' planes are at multiples of the interval, which is above 0, in the unit of
// heights: whole lines, from border to border or closed. What is at a multiple counts as below it:
// the line around a lake of that height is its shore. Whether a line crosses an edge is decided
// exactly. Time grows with the triangles and the pieces of the lines. Throws Error if there are
// more than 5 million pieces, or a multiple is too large.
std::vector<Contour> contours_of(const SurfaceModel& model, Decimal interval);

}  // namespace microtin::picture

#endif
