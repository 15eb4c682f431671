// SPDX-License-Identifier: MIT
// Writes paths with relative steps, which are short.
#include "encoder/picture/svg.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace microtin::picture {
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
