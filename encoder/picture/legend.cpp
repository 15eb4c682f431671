// SPDX-License-Identifier: MIT
// A ramp of colours with round numbers, and a bar of a round length.
#include "encoder/picture/legend.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "encoder/picture/lettering.hpp"

namespace microtin::picture {
namespace {

constexpr double kBarHeight = 6, kTick = 2, kLabelLine = 17;  // of labels: from the top of the bar
constexpr Colour kPaper{1, 1, 1};
constexpr int kMostDecimals = 9;

double label_width(double value, double step) {
  return text_width(grouped(value, decimals_for(step)));
}

// The finest round step whose numbers do not crowd a ramp of so many units.
double tick_step(double low, double high, double units) {
  const double range = high - low;
  const double coarsest = round_length(range);
  double best = coarsest, step = coarsest;
  while (step > 1e-9) {
    const double label = std::max(label_width(low, step), label_width(high, step));
    if (step / range * units < 1.5 * label + 3) break;
    best = step;
    step = round_length(step * 0.99);
  }
  return best;
}

void draw_label(Drawing& drawing, const std::string& text, double middle, double top, double left,
                double right, double unit) {
  const double width = unit * text_width(text);
  const double start = std::max(left, std::min(middle - width / 2, right - width));
  draw_text(drawing, text, {start, top + kLabelLine * unit}, unit, kInk);
}

}  // namespace

int decimals_for(double step) {
  return std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, kMostDecimals);
}

std::string grouped(double value, int decimals) {
  char buffer[400];
  std::snprintf(buffer, sizeof buffer, "%.*f", decimals, value);
  std::string text = buffer;
  if (text.find_first_not_of("-0.") == std::string::npos) text.erase(0, text[0] == '-' ? 1 : 0);
  const size_t sign = text[0] == '-' ? 1 : 0;
  const size_t whole = std::min(text.find('.'), text.size());
  for (size_t i = whole; i > sign + 3;) text.insert(i -= 3, ",");
  return text;
}

std::string rounded_text(double value) {
  const double magnitude = std::abs(value);
  const int whole = magnitude == 0 ? 1 : static_cast<int>(std::floor(std::log10(magnitude))) + 1;
  std::string text = grouped(value, std::clamp(4 - whole, 0, kMostDecimals));
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

double round_length(double most) {
  const double power = std::pow(10, std::floor(std::log10(most)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= most) return digit * power;
  }
  return power;
}

void draw_ramp(Drawing& drawing, Spot corner, double width, double unit, double low, double high,
               const std::function<Colour(double)>& colour) {
  const PixelBox box{corner.x, corner.y, width, kBarHeight * unit};
  for (uint32_t x = 0; x < width; ++x) {
    const double step = std::min(1.0, width - x);
    drawing.fill({corner.x + x, corner.y, step, box.height}, colour((x + step / 2) / width));
  }
  drawing.outline(box, std::max(1.0, 0.6 * unit), kInk);
  if (high <= low) return;  // one colour, told already
  const double step = tick_step(low, high, width / unit);
  const double first = step * std::ceil(low / step - 1e-9);
  const auto ticks = static_cast<uint32_t>((high - first) / step + 1 + 1e-9);
  for (uint32_t tick = 0; tick < ticks; ++tick) {
    const double value = first + tick * step;
    const double x = corner.x + width * (value - low) / (high - low);
    drawing.fill({x - unit * 0.4, corner.y + box.height, unit * 0.8, kTick * unit}, kInk);
    draw_label(drawing, grouped(value, decimals_for(step)), x, corner.y, corner.x, corner.x + width,
               unit);
  }
}

void draw_scale_bar(Drawing& drawing, Spot corner, double most, double unit, double ground,
                    const std::string& ground_unit) {
  constexpr int kParts = 4;
  const double length = round_length(most * ground);
  const bool in_thousands = ground_unit == "m" && length >= 1000;
  const double told = in_thousands ? length / 1000 : length;
  const PixelBox box{corner.x, corner.y + (kBarHeight - 4) * unit, length / ground, 4 * unit};
  for (int part = 0; part < kParts; ++part) {
    drawing.fill({box.left + part * box.width / kParts, box.top, box.width / kParts, box.height},
                 part % 2 == 0 ? kInk : kPaper);
  }
  drawing.outline(box, std::max(1.0, 0.6 * unit), kInk);
  const std::string text =
      grouped(told, decimals_for(told)) + " " + (in_thousands ? "k" : "") + ground_unit;
  draw_text(drawing, "0", {corner.x, corner.y + kLabelLine * unit}, unit, kInk);
  const double end =
      std::max(box.left + box.width - unit * text_width(text) / 2, corner.x + 12 * unit);
  draw_text(drawing, text, {end, corner.y + kLabelLine * unit}, unit, kInk);
}

void draw_swatch(Drawing& drawing, Spot corner, double unit, Colour colour,
                 const std::string& text) {
  const PixelBox box{corner.x, corner.y, 9 * unit, 7 * unit};
  drawing.fill(box, colour);
  drawing.outline(box, std::max(1.0, 0.6 * unit), kInk);
  draw_text(drawing, text, {corner.x + 13 * unit, corner.y + kCapHeight * unit}, unit, kInk);
}

}  // namespace microtin::picture
