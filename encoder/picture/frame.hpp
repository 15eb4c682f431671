// SPDX-License-Identifier: MIT
// A map in a picture: where the terrain lies, and the coordinates and legends around it.
#ifndef MICROTIN_ENCODER_PICTURE_FRAME_HPP
#define MICROTIN_ENCODER_PICTURE_FRAME_HPP

#include <functional>
#include <optional>
#include <string>

#include "encoder/export/mesh.hpp"
#include "encoder/layers.hpp"
#include "encoder/picture/drawing.hpp"
#include "encoder/terrain/metadata.hpp"

namespace microtin::picture {

// What a step of the lattice is on the ground.
struct Ground {
  double x, y;       // of these units; the same unit for both
  const char* unit;  // "m", "ft" or, if it is not known, "units"
};

// The length of a unit on the ground; of degrees, metres at the model's middle latitude.
Ground ground_of(const SurfaceModel& model, Unit horizontal);

// North is up, and a distance is as long in any direction. The box has whole pixels.
struct MapFrame {
  PixelBox box;
  double west, north;     // of the box, on the lattice
  double x_step, y_step;  // of the lattice, for a pixel

  // From the upper left corner of the box.
  Spot spot(double x, double y) const { return {(x - west) / x_step, (north - y) / y_step}; }
  // A spot of the map, from the corner of the picture.
  Spot in_picture(Spot spot) const { return {box.left + spot.x, box.top + spot.y}; }
  uint32_t columns() const { return static_cast<uint32_t>(box.width); }
  uint32_t rows() const { return static_cast<uint32_t>(box.height); }
};

// As large as a room of this many pixels allows, at the room's upper left corner.
MapFrame fit_map(const SurfaceModel& model, const Ground& ground, double width, double height);

// What stands around a map: coordinates and the north.

constexpr double kFrameRoom = 12;  // units that numbers take above and to the left of a map

// A line around the map, and ticks at round coordinates, in the unit of x and y, with numbers above
// and to the left. Those for which there is no room are left out.
void draw_coordinates(Drawing& drawing, const MapFrame& frame, const Placement& placement,
                      Unit horizontal, double unit);

// Where the arrow's middle is; nothing if the map is too small.
std::optional<Spot> north_arrow_of(const PixelBox& map, double unit);

// An arrow up, in the map's upper right corner; none if the map is too small.
void draw_north_arrow(Drawing& drawing, const PixelBox& map, double unit);

// What tells how to read a map.

constexpr Colour kInk{0.16, 0.18, 0.22};
constexpr Colour kHalo{0.98, 0.97, 0.94};  // around what stands on a map

// Sizes of legends are in units of this many pixels, as those of text.

// "1,234.5": with commas between thousands and this many decimals.
std::string grouped(double value, int decimals);

// Decimals that multiples of a round step need.
int decimals_for(double step);

// With four digits that matter, at most.
std::string rounded_text(double value);

// The largest 1, 2 or 5 times a power of ten up to a number above 0.
double round_length(double most);

// Colours from a lowest to a highest number, and round numbers below them; 18 units high.
void draw_ramp(Drawing& drawing, Spot corner, double width, double unit, double low, double high,
               const std::function<Colour(double)>& colour);

// A bar of a round length, at most this many pixels, its ends labelled below; 18 units high. A
// pixel is `ground` units on the ground; a thousand of "m" are written as "km".
void draw_scale_bar(Drawing& drawing, Spot corner, double most, double unit, double ground,
                    const std::string& ground_unit);

// A small box and what it means, 7 units high; the corner is the upper left one.
void draw_swatch(Drawing& drawing, Spot corner, double unit, Colour colour,
                 const std::string& text);

}  // namespace microtin::picture

#endif
