// SPDX-License-Identifier: MIT
// What pictures are drawn on: pixels, which become PNG files, or SVG files of lines and areas.
#include "encoder/picture/drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <new>

namespace microtin::picture {

// Blends lines and boxes into pixels.
// Ours: lines, boxes and letters are all; the pixels are the same whatever is installed.

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

// Hands pixels to the PNG writer.

namespace {

// The picture's writer goes on writing when memory is short: it must not come back to that. What
// it holds is lost, as the program ends.
void* allocate(size_t size) {
  return ::operator new(std::max<size_t>(size, 1));  // clang's analyzer follows a size of 0
}

void release(void* memory) {
  ::operator delete(memory);
}

void* grow(void* old, size_t old_size, size_t size) {
  void* const grown = allocate(size);
  std::copy_n(static_cast<const char*>(old), std::min(old_size, size), static_cast<char*>(grown));
  release(old);
  return grown;
}

}  // namespace

// Functions: where the writer has "a ? STBIW_FREE(b), 0 : 0", clang 14 calls a plain ::operator
// delete for any a.
#define STBIW_MALLOC(size) allocate(static_cast<size_t>(size))
#define STBIW_REALLOC_SIZED(old, old_size, size) \
  grow(old, static_cast<size_t>(old_size), static_cast<size_t>(size))
#define STBIW_FREE(memory) release(memory)
#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

#include "encoder/base/error.hpp"

namespace microtin::picture {

std::vector<uint8_t> png(const std::vector<uint8_t>& rgb, uint32_t width, uint32_t height) {
  const auto append = [](void* file, void* data, int size) {
    const auto* bytes = static_cast<const uint8_t*>(data);
    static_cast<std::vector<uint8_t>*>(file)->insert(
        static_cast<std::vector<uint8_t>*>(file)->end(), bytes, bytes + size);
  };
  std::vector<uint8_t> file;
  const int w = static_cast<int>(width), h = static_cast<int>(height);
  if (stbi_write_png_to_func(append, &file, w, h, 3, rgb.data(), 3 * w) == 0) {
    throw Error("the picture does not fit into memory; make it narrower");
  }
  return file;
}

// Writes paths with relative steps, which are short.

namespace {

std::string tenths(int64_t value) {
  std::string text = value < 0 ? "-" : "";
  const int64_t size = value < 0 ? -value : value;
  if (size >= 10 || size == 0) text += std::to_string(size / 10);
  if (size % 10 != 0) text += "." + std::to_string(size % 10);
  return text;
}

std::string number(double value) {
  return tenths(std::llround(value * 10));
}

std::string hue(Colour colour) {
  const auto byte = [](double part) {
    return static_cast<unsigned>(std::lround(part * 255)) & 255u;
  };
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", byte(colour.r), byte(colour.g),
                byte(colour.b));
  return text.data();
}

std::string hundredths(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f", value);
  return text.data();
}

}  // namespace

Svg::Svg(uint32_t width, uint32_t height, Colour paper) {
  const std::string w = std::to_string(width), h = std::to_string(height);
  text_ = R"(<svg xmlns="http://www.w3.org/2000/svg" width=")" + w + R"(" height=")" + h +
          R"(" viewBox="0 0 )" + w + ' ' + h +
          R"(" fill="none" stroke-linecap="round" stroke-linejoin="round">)"
          "\n";
  Svg::fill({0, 0, static_cast<double>(width), static_cast<double>(height)}, paper);
}

void Svg::begin(const std::string& style) {
  if (style == style_) return;
  end();
  text_ += "<path " + style + R"( d=")";
  style_ = style;
}

void Svg::end() {
  if (!style_.empty()) text_ += "\"/>\n";
  style_.clear();
  has_pen_ = false;
}

void Svg::add_step(char command, Tenths to) {
  const std::string x = tenths(to.x - pen_.x), y = tenths(to.y - pen_.y);
  text_ += command + x + (y.front() == '-' ? "" : " ") + y;
  pen_ = to;
}

void Svg::move_to(Spot place) {
  const Tenths to{std::llround(place.x * 10), std::llround(place.y * 10)};
  if (has_pen_ && to.x == pen_.x && to.y == pen_.y) return;
  if (!has_pen_) pen_ = {0, 0};  // the first step of a path is from there
  add_step('m', to);
  has_pen_ = true;
}

void Svg::line_to(Spot place) {
  add_step('l', {std::llround(place.x * 10), std::llround(place.y * 10)});
}

void Svg::fill(const PixelBox& box, Colour colour) {
  end();
  text_ += R"(<rect x=")" + number(box.left) + R"(" y=")" + number(box.top) + R"(" width=")" +
           number(box.width) + R"(" height=")" + number(box.height) + R"(" fill=")" + hue(colour) +
           "\"/>\n";
}

void Svg::stroke(Spot a, Spot b, double line_width, Colour colour) {
  line({a, b}, line_width, colour, 1);
}

void Svg::area(const std::vector<Spot>& corners, Colour colour) {
  begin(R"(fill=")" + hue(colour) + R"(" stroke=")" + hue(colour) + R"(" stroke-width=".4")");
  move_to(corners.front());
  const Tenths first = pen_;
  for (size_t i = 1; i < corners.size(); ++i) line_to(corners[i]);
  text_ += 'z';
  pen_ = first;  // where closing leads
  has_pen_ = true;
}

void Svg::line(const std::vector<Spot>& places, double line_width, Colour colour, double strength) {
  begin(R"(stroke=")" + hue(colour) + R"(" stroke-width=")" + hundredths(line_width) + '"' +
        (strength < 1 ? R"( stroke-opacity=")" + hundredths(strength) + '"' : ""));
  move_to(places.front());
  for (size_t i = 1; i < places.size(); ++i) line_to(places[i]);
}

std::string Svg::take() {
  end();
  text_ += "</svg>\n";
  return std::move(text_);
}

}  // namespace microtin::picture
