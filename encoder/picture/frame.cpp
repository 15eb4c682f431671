// SPDX-License-Identifier: MIT
// Finds round coordinates that leave room for their numbers.
#include "encoder/picture/frame.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "encoder/picture/legend.hpp"
#include "encoder/picture/lettering.hpp"

namespace microtin::picture {
namespace {

constexpr double kTick = 3, kRim = 0.6, kTextGap = 2.5;  // units

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

double step_of(const Scale& scale) {
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
  const double step = step_of(scale), range = scale.high - scale.low;
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
  const double rim = std::max(1.0, kRim * unit), tick = kTick * unit, line = 0.8 * unit;
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

}  // namespace microtin::picture
