// SPDX-License-Identifier: MIT
// Blends lines and boxes into pixels.
// Ours: lines, boxes and letters are all; the pixels are the same whatever is installed.
#include "encoder/picture/canvas.hpp"

namespace microtin::picture {
namespace {

uint8_t mixed(uint8_t below, double above, double part) {
  return static_cast<uint8_t>(std::lround(below + (above * 255 - below) * part));
}

// The length of the part of [low, high] within the pixel that begins at `pixel`.
double shared_length(double low, double high, uint32_t pixel) {
  return std::max(0.0, std::min(high, pixel + 1.0) - std::max(low, static_cast<double>(pixel)));
}

}  // namespace

Canvas::Canvas(uint32_t width, uint32_t height, Colour paper)
    : width_(width), height_(height), rgb_(size_t{3} * width * height) {
  Canvas::fill({0, 0, static_cast<double>(width), static_cast<double>(height)}, paper);
}

void Canvas::blend(uint32_t column, uint32_t row, Colour colour, double part) {
  uint8_t* const p = &rgb_[3 * (size_t{row} * width_ + column)];
  p[0] = mixed(p[0], colour.r, part);
  p[1] = mixed(p[1], colour.g, part);
  p[2] = mixed(p[2], colour.b, part);
}

void Canvas::fill(const PixelBox& box, Colour colour) {
  const double right = std::min<double>(box.left + box.width, width_);
  const double bottom = std::min<double>(box.top + box.height, height_);
  for (auto row = static_cast<uint32_t>(std::max(0.0, box.top)); row < bottom; ++row) {
    const double rows = shared_length(box.top, bottom, row);
    for (auto column = static_cast<uint32_t>(std::max(0.0, box.left)); column < right; ++column) {
      blend(column, row, colour, rows * shared_length(box.left, right, column));
    }
  }
}

void Canvas::stroke(Spot a, Spot b, double line_width, Colour colour) {
  const PixelBox all{0, 0, static_cast<double>(width_), static_cast<double>(height_)};
  const double reach = line_width / 2 + 0.5;
  for_each_pixel_near(a, b, reach, all, [&](uint32_t column, uint32_t row, double distance) {
    blend(column, row, colour, std::min(1.0, reach - distance));
  });
}

}  // namespace microtin::picture
