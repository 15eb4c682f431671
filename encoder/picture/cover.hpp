// SPDX-License-Identifier: MIT
// Many lines of one colour: where several meet it is no darker.
#ifndef MICROTIN_ENCODER_PICTURE_COVER_HPP
#define MICROTIN_ENCODER_PICTURE_COVER_HPP

#include <algorithm>
#include <cstdint>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/picture/canvas.hpp"

namespace microtin::picture {

class Cover {
 public:
  // Covers a box of whole pixels.
  explicit Cover(const PixelBox& box)
      : box_(box),
        columns_(static_cast<uint32_t>(box.width)),
        parts_(size_t{columns_} * static_cast<uint32_t>(box.height)) {}

  // From the upper left corner of the box. Each pixel takes the strongest line alone; 0 .. 1.
  void stroke(Spot a, Spot b, double line_width, double strength) {
    const double reach = line_width / 2 + 0.5, full = 255 * strength;
    for_each_pixel_near(a, b, reach, {0, 0, box_.width, box_.height},
                        [&](uint32_t column, uint32_t row, double distance) {
                          uint8_t& part = parts_[size_t{row} * columns_ + column];
                          part = std::max(
                              part, static_cast<uint8_t>(full * std::min(1.0, reach - distance)));
                        });
  }

  // `strength_of` a column of the box: 0 .. 1.
  template <class StrengthOf>
  void blend(Canvas& canvas, Colour colour, const StrengthOf& strength_of) const {
    for (size_t pixel = 0; pixel < parts_.size(); ++pixel) {
      const auto column = static_cast<uint32_t>(pixel % columns_);
      canvas.blend(static_cast<uint32_t>(box_.left) + column,
                   static_cast<uint32_t>(box_.top) + static_cast<uint32_t>(pixel / columns_),
                   colour, parts_[pixel] / 255.0 * strength_of(column));
    }
  }

 private:
  PixelBox box_;
  uint32_t columns_;
  std::vector<uint8_t> parts_;
};

}  // namespace microtin::picture

#endif
