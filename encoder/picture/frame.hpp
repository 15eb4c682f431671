// SPDX-License-Identifier: MIT
// What stands around a map: coordinates and the north.
#ifndef MICROTIN_ENCODER_PICTURE_FRAME_HPP
#define MICROTIN_ENCODER_PICTURE_FRAME_HPP

#include <optional>

#include "encoder/exact/metadata.hpp"
#include "encoder/layers.hpp"
#include "encoder/picture/drawing.hpp"
#include "encoder/picture/map_frame.hpp"

namespace microtin::picture {

constexpr double kFrameRoom = 12;  // units that numbers take above and to the left of a map

// A line around the map, and ticks at round coordinates, in the unit of x and y, with numbers above
// and to the left. Those for which there is no room are left out.
void draw_coordinates(Drawing& drawing, const MapFrame& frame, const Placement& placement,
                      Unit horizontal, double unit);

// Where the arrow's middle is; nothing if the map is too small.
std::optional<Spot> north_arrow_of(const PixelBox& map, double unit);

// An arrow up, in the map's upper right corner; none if the map is too small.
void draw_north_arrow(Drawing& drawing, const PixelBox& map, double unit);

}  // namespace microtin::picture

#endif
