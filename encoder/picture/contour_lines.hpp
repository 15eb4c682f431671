// SPDX-License-Identifier: MIT
// Drawing contours on a map, with their heights.
#ifndef MICROTIN_ENCODER_PICTURE_CONTOUR_LINES_HPP
#define MICROTIN_ENCODER_PICTURE_CONTOUR_LINES_HPP

#include <optional>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/picture/contours.hpp"
#include "encoder/picture/map_frame.hpp"
#include "encoder/picture/palette.hpp"

namespace microtin::picture {

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

}  // namespace microtin::picture

#endif
