// SPDX-License-Identifier: MIT
// Lines on a map: those of equal height with their heights, and those of the terrain.
#ifndef MICROTIN_ENCODER_PICTURE_MAP_LINES_HPP
#define MICROTIN_ENCODER_PICTURE_MAP_LINES_HPP

#include <optional>
#include <vector>

#include "encoder/export/mesh.hpp"
#include "encoder/layers.hpp"
#include "encoder/picture/drawing.hpp"
#include "encoder/picture/frame.hpp"
#include "encoder/picture/palette.hpp"
#include "encoder/stream/edge_marks.hpp"

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

// A contour on a map, in pixels from the map's corner.
struct ContourLine {
  std::vector<Spot> places;
  double width;     // pixels
  double strength;  // 0 .. 1
  bool is_sea;      // its colour
};

Colour colour_of(const ContourLine& line);

// Index contours are heavier. `unit` as of legends.
std::vector<ContourLine> contour_lines(const MapFrame& frame, const std::vector<Contour>& contours,
                                       PaletteKind palette, double unit);

// Where several meet they are no darker.
void draw_contours(Canvas& canvas, const MapFrame& frame, const std::vector<ContourLine>& lines);

// The heights of index contours, or of all if there are none, where there is room along them; not
// near a place of the picture that something else occupies. `lines` are those of the contours.
void label_contours(Drawing& drawing, const MapFrame& frame, const std::vector<Contour>& contours,
                    const std::vector<ContourLine>& lines, Decimal interval, double unit,
                    std::optional<Spot> occupied);

// In the colour of each line's class. The lines' vertices are those of the model; `unit` as of
// legends.
void draw_marked_lines(Drawing& drawing, const MapFrame& frame, const SurfaceModel& model,
                       const std::vector<MarkedLine>& lines, double unit);

}  // namespace microtin::picture

#endif
