// SPDX-License-Identifier: MIT
// A map in a picture: where the terrain lies, and the coordinates and legends around it.
#include "encoder/picture/frame.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>

#include "encoder/export/scene.hpp"
#include "encoder/picture/drawing.hpp"

namespace microtin::picture {

// Fits a terrain into a box, degrees corrected for its latitude.

namespace {

struct Extent {
  int64_t west, east, south, north;
};

Extent extent_of(const SurfaceModel& model) {
  const auto& [x, y, z] = model.vertices.front();
  Extent extent{x, x, y, y};
  for (const auto& vertex : model.vertices) {
    extent.west = std::min(extent.west, vertex[0]);
    extent.east = std::max(extent.east, vertex[0]);
    extent.south = std::min(extent.south, vertex[1]);
    extent.north = std::max(extent.north, vertex[1]);
  }
  return extent;
}

}  // namespace

Ground ground_of(const SurfaceModel& model, Unit horizontal) {
  const double x = step_of(model.placement.x), y = step_of(model.placement.y);
  switch (horizontal) {
    case Unit::kMetre:
      return {x, y, "m"};
    case Unit::kFoot:
    case Unit::kUsSurveyFoot:
      return {x, y, "ft"};
    case Unit::kDegree: {
      const Extent extent = extent_of(model);
      const double middle = static_cast<double>(extent.south + extent.north) / 2;
      const Degree degree = degree_at(offset_of(model.placement.y) + y * middle);
      return {x * degree.x, y * degree.y, "m"};
    }
    case Unit::kUnknown:
      break;
  }
  return {x, y, "units"};
}

MapFrame fit_map(const SurfaceModel& model, const Ground& ground, double width, double height) {
  const Extent extent = extent_of(model);
  const auto columns = static_cast<double>(extent.east - extent.west);
  const auto rows = static_cast<double>(extent.north - extent.south);
  const double scale = std::max(columns * ground.x / width, rows * ground.y / height);
  MapFrame frame{};
  frame.box.width = std::clamp(std::round(columns * ground.x / scale), 1.0, std::floor(width));
  frame.box.height = std::clamp(std::round(rows * ground.y / scale), 1.0, std::floor(height));
  frame.west = static_cast<double>(extent.west);
  frame.north = static_cast<double>(extent.north);
  frame.x_step = columns / frame.box.width;
  frame.y_step = rows / frame.box.height;
  return frame;
}

// Finds round coordinates that leave room for their numbers.

namespace {

constexpr double kAxisTick = 3, kRim = 0.6, kTextGap = 2.5;  // units

// One side of a map.
struct Scale {
  double low, high;  // coordinates at its ends
  double length;     // in units
  bool degrees;
  const char* ends;  // for degrees: letters below and above 0

  std::string label(double value, double step) const {
    const int decimals = decimals_for(step);
    if (!degrees) return grouped(value, decimals);
    const std::string number = grouped(std::abs(value), decimals) + "\xC2\xB0";
    return std::abs(value) < step / 2 ? number : number + (value < 0 ? ends[0] : ends[1]);
  }

  double label_width(double step) const {
    return std::max(text_width(label(low, step)), text_width(label(high, step)));
  }
};

// 1, 2 or 5 times a power of ten from a number above 0 on.
double round_step_from(double least) {
  const double power = std::pow(10, std::floor(std::log10(least) + 1e-9));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= least * (1 - 1e-9)) return digit * power;
  }
  return 10 * power;
}

double round_step_of(const Scale& scale) {
  constexpr double kSparse = 70;  // units between ticks, at least
  const double per_unit = (scale.high - scale.low) / scale.length;
  double step = round_step_from(kSparse * per_unit);
  while (step < scale.high - scale.low && step / per_unit < 1.6 * scale.label_width(step)) {
    step = round_step_from(1.01 * step);
  }
  return step;
}

// Calls visit(place, label) for each tick: the place from 0, low, to 1, high.
template <class Visit>
void for_each_tick(const Scale& scale, const Visit& visit) {
  if (!(scale.high > scale.low)) return;
  const double step = round_step_of(scale), range = scale.high - scale.low;
  const double first = std::ceil(scale.low / step - 1e-9);
  const double last = std::floor(scale.high / step + 1e-9);
  for (int tick = 0; tick <= last - first; ++tick) {
    const double value = (first + tick) * step;
    visit(std::clamp((value - scale.low) / range, 0.0, 1.0), scale.label(value, step));
  }
}

}  // namespace

void draw_coordinates(Drawing& drawing, const MapFrame& frame, const Placement& placement,
                      Unit horizontal, double unit) {
  const PixelBox& box = frame.box;
  const bool degrees = horizontal == Unit::kDegree;
  const double rim = std::max(1.0, kRim * unit), tick = kAxisTick * unit, line = 0.8 * unit;
  const double west = offset_of(placement.x) + exact::step_of(placement.x) * frame.west;
  const double north = offset_of(placement.y) + exact::step_of(placement.y) * frame.north;
  const double east = west + exact::step_of(placement.x) * frame.x_step * box.width;
  const double south = north - exact::step_of(placement.y) * frame.y_step * box.height;
  drawing.outline(box, rim, kInk);
  for_each_tick(
      {west, east, box.width / unit, degrees, "WE"}, [&](double at, const std::string& text) {
        const double x = box.left + at * box.width, half = unit * text_width(text) / 2;
        drawing.fill({x - line / 2, box.top - tick, line, tick}, kInk);
        drawing.fill({x - line / 2, box.top + box.height, line, tick}, kInk);
        const double room = kFrameRoom * unit;
        if (x - half < box.left - room || x + half > box.left + box.width + 0.6 * room) return;
        draw_text(drawing, text, {x - half, box.top - tick - kTextGap * unit}, unit, kInk);
      });
  for_each_tick({south, north, box.height / unit, degrees, "SN"}, [&](double at,
                                                                      const std::string& text) {
    const double y = box.top + (1 - at) * box.height, half = unit * text_width(text) / 2;
    drawing.fill({box.left - tick, y - line / 2, tick, line}, kInk);
    drawing.fill({box.left + box.width, y - line / 2, tick, line}, kInk);
    if (y - half < box.top || y + half > box.top + box.height) return;
    draw_text(drawing, text, {box.left - tick - kTextGap * unit, y + half}, unit, kInk, {0, -1});
  });
}

std::optional<Spot> north_arrow_of(const PixelBox& map, double unit) {
  if (std::min(map.width, map.height) < 64 * unit) return std::nullopt;
  return Spot{map.left + map.width - 12 * unit, map.top + 25 * unit};
}

void draw_north_arrow(Drawing& drawing, const PixelBox& map, double unit) {
  constexpr double kHalf = 13;  // of the height
  const std::optional<Spot> middle = north_arrow_of(map, unit);
  if (!middle) return;
  const auto draw = [&](double pen, Colour colour) {
    const Spot tip{middle->x, middle->y - (kHalf - kCapHeight - 3) * unit};
    drawing.stroke(tip, {middle->x, middle->y + kHalf * unit}, pen, colour);
    for (const double side : {-2.8, 2.8}) {
      drawing.stroke(tip, {tip.x + side * unit, tip.y + 7.2 * unit}, pen, colour);
    }
    draw_text(drawing, "N",
              {tip.x - unit * text_width("N") / 2, middle->y - (kHalf - kCapHeight) * unit}, unit,
              colour, {1, 0}, pen / unit);
  };
  draw(4.5 * unit, kHalo);
  draw(1.3 * unit, kInk);
}

// A ramp of colours with round numbers, and a bar of a round length.

namespace {

constexpr double kBarHeight = 6, kBarTick = 2,
                 kLabelLine = 17;  // of labels: from the top of the bar
constexpr Colour kBarPaper{1, 1, 1};
constexpr int kMostDecimals = 9;

double label_width(double value, double step) {
  return text_width(grouped(value, decimals_for(step)));
}

// The finest round step whose numbers do not crowd a ramp of this many units.
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
  if (high <= low) return;  // one colour, which has its label already
  const double step = tick_step(low, high, width / unit);
  const double first = step * std::ceil(low / step - 1e-9);
  const auto ticks = static_cast<uint32_t>((high - first) / step + 1 + 1e-9);
  for (uint32_t tick = 0; tick < ticks; ++tick) {
    const double value = first + tick * step;
    const double x = corner.x + width * (value - low) / (high - low);
    drawing.fill({x - unit * 0.4, corner.y + box.height, unit * 0.8, kBarTick * unit}, kInk);
    draw_label(drawing, grouped(value, decimals_for(step)), x, corner.y, corner.x, corner.x + width,
               unit);
  }
}

void draw_scale_bar(Drawing& drawing, Spot corner, double most, double unit, double ground,
                    const std::string& ground_unit) {
  constexpr int kParts = 4;
  const double length = round_length(most * ground);
  const bool in_thousands = ground_unit == "m" && length >= 1000;
  const double shown = in_thousands ? length / 1000 : length;
  const PixelBox box{corner.x, corner.y + (kBarHeight - 4) * unit, length / ground, 4 * unit};
  for (int part = 0; part < kParts; ++part) {
    drawing.fill({box.left + part * box.width / kParts, box.top, box.width / kParts, box.height},
                 part % 2 == 0 ? kInk : kBarPaper);
  }
  drawing.outline(box, std::max(1.0, 0.6 * unit), kInk);
  const std::string text =
      grouped(shown, decimals_for(shown)) + " " + (in_thousands ? "k" : "") + ground_unit;
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
