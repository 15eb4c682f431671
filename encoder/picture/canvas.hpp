// SPDX-License-Identifier: MIT
// A picture to draw on, with soft edges.
#ifndef MICROTIN_ENCODER_PICTURE_CANVAS_HPP
#define MICROTIN_ENCODER_PICTURE_CANVAS_HPP

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/picture/drawing.hpp"

namespace microtin::picture {

// Calls visit(column, row, distance) for the pixels with middles nearer than `reach` to a segment.
template <class Visit>
void for_each_pixel_near(Spot a, Spot b, double reach, const PixelBox& within, const Visit& visit) {
  const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
  // The pixels with middles in a range: the first, and the one behind the last.
  const auto first = [](double low) { return static_cast<uint32_t>(std::ceil(low - 0.5)); };
  const auto end = [](double high) {
    return static_cast<uint32_t>(std::max(0.0, std::floor(high + 0.5)));
  };
  const double top = std::max(std::min(a.y, b.y) - reach, within.top);
  const double bottom = std::min(std::max(a.y, b.y) + reach, within.top + within.height);
  for (uint32_t row = first(top); row < end(bottom); ++row) {
    const double y = row + 0.5;
    // The part of the segment that is near this row.
    const double t0 = dy == 0 ? 0 : std::clamp((y - reach - a.y) / dy, 0.0, 1.0);
    const double t1 = dy == 0 ? 1 : std::clamp((y + reach - a.y) / dy, 0.0, 1.0);
    const double x0 = a.x + t0 * dx, x1 = a.x + t1 * dx;
    const double left = std::max(std::min(x0, x1) - reach, within.left);
    const double right = std::min(std::max(x0, x1) + reach, within.left + within.width);
    for (uint32_t column = first(left); column < end(right); ++column) {
      const double x = column + 0.5;
      const double t =
          square == 0 ? 0 : std::clamp(((x - a.x) * dx + (y - a.y) * dy) / square, 0.0, 1.0);
      const double distance = std::hypot(x - a.x - t * dx, y - a.y - t * dy);
      if (distance < reach) visit(column, row, distance);
    }
  }
}

class Canvas final : public Drawing {
 public:
  Canvas(uint32_t width, uint32_t height, Colour paper);

  uint32_t width() const { return width_; }
  uint32_t height() const { return height_; }

  // Covers a part of a pixel of the picture: 0 .. 1.
  void blend(uint32_t column, uint32_t row, Colour colour, double part);

  void fill(const PixelBox& box, Colour colour) override;
  void stroke(Spot a, Spot b, double line_width, Colour colour) override;

  // Three bytes for each pixel, top row first.
  const std::vector<uint8_t>& rgb() const { return rgb_; }

 private:
  uint32_t width_, height_;
  std::vector<uint8_t> rgb_;
};

}  // namespace microtin::picture

#endif
