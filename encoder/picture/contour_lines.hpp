// SPDX-License-Identifier: MIT
// Drawing contours on a map, with their heights.
#ifndef MICROTIN_ENCODER_PICTURE_CONTOUR_LINES_HPP
#define MICROTIN_ENCODER_PICTURE_CONTOUR_LINES_HPP

#include "encoder/layers.hpp"
#include "encoder/picture/contours.hpp"
#include "encoder/picture/map_frame.hpp"
#include "encoder/picture/palette.hpp"

namespace microtin::picture {

// Index contours are heavier, and told apart by their heights where there is room along them; if
// there are none, all are. `unit` as of legends.
void draw_contours(Canvas& canvas, const MapFrame& frame, const std::vector<Contour>& contours,
                   Decimal interval, PaletteKind palette, double unit);

}  // namespace microtin::picture

#endif
