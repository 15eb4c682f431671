// SPDX-License-Identifier: MIT
// What legends, letters and frames are drawn on: pixels, or a file of lines.
#ifndef MICROTIN_ENCODER_PICTURE_DRAWING_HPP
#define MICROTIN_ENCODER_PICTURE_DRAWING_HPP

#include "encoder/export/colour.hpp"
#include "encoder/layers.hpp"

namespace microtin::picture {

// In pixels, from the upper left corner of the picture; the middle of the first pixel is at 0.5.
struct Spot {
  double x, y;
};

struct PixelBox {
  double left, top, width, height;
};

class Drawing {
 public:
  Drawing() = default;
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;
  virtual ~Drawing() = default;

  virtual void fill(const PixelBox& box, Colour colour) = 0;

  // A line with round ends. What lies outside the picture is left out.
  virtual void stroke(Spot a, Spot b, double line_width, Colour colour) = 0;

  // Around a box.
  void outline(const PixelBox& box, double line_width, Colour colour) {
    const double right = box.left + box.width, bottom = box.top + box.height;
    const double wide = box.width + 2 * line_width;
    fill({box.left - line_width, box.top - line_width, wide, line_width}, colour);
    fill({box.left - line_width, bottom, wide, line_width}, colour);
    fill({box.left - line_width, box.top, line_width, box.height}, colour);
    fill({right, box.top, line_width, box.height}, colour);
  }
};

}  // namespace microtin::picture

#endif
