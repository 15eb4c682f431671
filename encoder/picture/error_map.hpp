// SPDX-License-Identifier: MIT
// Drawing how far a terrain is from its source.
#ifndef MICROTIN_ENCODER_PICTURE_ERROR_MAP_HPP
#define MICROTIN_ENCODER_PICTURE_ERROR_MAP_HPP

#include "encoder/layers.hpp"
#include "encoder/picture/frame.hpp"

namespace microtin::picture {

// From -1, too low, over 0 to 1, too high.
Colour error_colour(double relative);

class ErrorMap {
 public:
  // `cell` lattice steps lie between posts. Each post is drawn as large as the whole steps that may
  // lie between their places on the lattice, so that neighbours meet.
  ErrorMap(const MapFrame& frame, Spot cell);

  // The error of a post at a place on the lattice. A pixel keeps the largest one in it.
  void add(double x, double y, double above);

  // Errors of a magnitude of `scale` get the full colours.
  void draw(Canvas& canvas, double scale) const;

 private:
  MapFrame frame_;
  Spot reach_;  // in pixels
  std::vector<float> errors_;
};

}  // namespace microtin::picture

#endif
