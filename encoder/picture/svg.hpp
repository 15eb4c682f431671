// SPDX-License-Identifier: MIT
// A picture as a file of lines and areas.
#ifndef MICROTIN_ENCODER_PICTURE_SVG_HPP
#define MICROTIN_ENCODER_PICTURE_SVG_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/picture/drawing.hpp"

namespace microtin::picture {

// Places are rounded to tenths of a pixel. What follows each other in one style is one element.
class Svg final : public Drawing {
 public:
  Svg(uint32_t width, uint32_t height, Colour paper);

  void fill(const PixelBox& box, Colour colour) override;
  void stroke(Spot a, Spot b, double line_width, Colour colour) override;

  // A closed area, with a rim that hides the seam to its neighbours.
  void area(const std::vector<Spot>& corners, Colour colour);

  // A line through all places, `strength` 0 .. 1.
  void line(const std::vector<Spot>& places, double line_width, Colour colour, double strength);

  // The whole file. Nothing is drawn any more.
  std::string take();

 private:
  struct Tenths {
    int64_t x, y;
  };

  void begin(const std::string& style);
  void end();
  void move_to(Spot place);
  void line_to(Spot place);
  void add_step(char command, Tenths to);

  std::string text_;
  std::string style_;     // of the element that is open; empty: none is
  Tenths pen_{0, 0};      // in the open element
  bool has_pen_ = false;  // a line may go on from there
};

}  // namespace microtin::picture

#endif
