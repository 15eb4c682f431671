// SPDX-License-Identifier: MIT
// What pictures are drawn on: pixels, which become PNG files, or SVG files of lines and areas; and
// text on it.
#ifndef MICROTIN_ENCODER_PICTURE_DRAWING_HPP
#define MICROTIN_ENCODER_PICTURE_DRAWING_HPP

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/export/scene.hpp"
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

// A picture to draw on, with soft edges.

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

// Many lines of one colour: where several meet it is no darker.

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

// Images as PNG files.

// `rgb` holds width * height pixels of three bytes, top row first.
std::vector<uint8_t> png(const std::vector<uint8_t>& rgb, uint32_t width, uint32_t height);

// A picture as a file of lines and areas.

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

// Text, which has a source of its own.

// Digits and capitals are 7 units high, letters reach 2 below the line.
constexpr double kCapHeight = 7;

// The first character that is not drawn; empty if all are. There are digits, Latin letters with
// Western accents (those up to U+00FF), blanks and . , : ; ! ? + - = / & _ ( ) ' " and the degree.
std::string_view missing_letter(std::string_view text);

// In units: without the room behind the last character.
double text_width(std::string_view text);

constexpr double kPen = 0.8;  // how wide strokes are, in units

// `start` is where the first character begins on the line, `unit` a number of pixels, `along` the
// direction in which text runs, of length 1. UTF-8; missing letters leave a blank.
void draw_text(Drawing& drawing, std::string_view text, Spot start, double unit, Colour colour,
               Spot along = {1, 0}, double pen = kPen);

}  // namespace microtin::picture

#endif
