// SPDX-License-Identifier: MIT
// Where a terrain lies in a picture.
#ifndef MICROTIN_ENCODER_PICTURE_MAP_FRAME_HPP
#define MICROTIN_ENCODER_PICTURE_MAP_FRAME_HPP

#include "encoder/export/export.hpp"
#include "encoder/layers.hpp"
#include "encoder/picture/canvas.hpp"

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

// As large as a room of so many pixels allows, at the room's upper left corner.
MapFrame fit_map(const SurfaceModel& model, const Ground& ground, double width, double height);

}  // namespace microtin::picture

#endif
