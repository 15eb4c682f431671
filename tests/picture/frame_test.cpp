// SPDX-License-Identifier: MIT
// Coordinates around maps: where ticks and numbers are.
#include "encoder/picture/frame.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "tests/support/layers.hpp"

using namespace microtin::tests;

namespace {

// Keeps what is drawn.
class Recorder final : public Drawing {
 public:
  void fill(const PixelBox& box, Colour) override { fills.push_back(box); }
  void stroke(Spot a, Spot b, double line_width, Colour) override {
    for (const Spot end : {a, b}) {
      left = std::min(left, end.x - line_width / 2);
      right = std::max(right, end.x + line_width / 2);
      top = std::min(top, end.y - line_width / 2);
      bottom = std::max(bottom, end.y + line_width / 2);
    }
    ++strokes;
  }

  std::vector<PixelBox> fills;
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
  int strokes = 0;
};

MapFrame map_of(double width, double height) {
  MapFrame frame{};
  frame.box = {100, 100, width, height};
  frame.west = 10;
  frame.north = 40;
  frame.x_step = frame.y_step = 0.1;
  return frame;
}

Placement placed(int64_t x, int64_t y, uint64_t step, uint64_t parts) {
  return {{x, step, parts}, {y, step, parts}, {0, 1, 1}};
}

// The coordinates of ticks above the map, in order.
std::vector<double> ticks_above(const Recorder& drawn, const MapFrame& frame,
                                const Placement& placement) {
  std::vector<double> found;
  for (const PixelBox& tick : drawn.fills) {
    if (tick.top + tick.height > frame.box.top || tick.width > 2) continue;
    const double column = tick.left + tick.width / 2 - frame.box.left;
    found.push_back(offset_of(placement.x) +
                    microtin::exact::step_of(placement.x) * (frame.west + frame.x_step * column));
  }
  return found;
}

}  // namespace

TEST_CASE("frame: ticks are at all multiples of a round number in the map, and nowhere else") {
  for (const double width : {120.0, 400.0, 1000.0, 3000.0}) {
    for (const Placement& placement :
         {placed(0, 0, 1, 1), placed(4'850'000, 350'000, 30, 1), placed(-777, -333, 1, 1200),
          placed(-12, 12, 1, 7), placed(1, 1, uint64_t{1} << 39, 3)}) {
      const MapFrame frame = map_of(width, 300);
      Recorder drawn;
      draw_coordinates(drawn, frame, placement, Unit::kMetre, 1);
      const std::vector<double> at = ticks_above(drawn, frame, placement);
      const double pixel = microtin::exact::step_of(placement.x) * frame.x_step;
      const double west =
          offset_of(placement.x) + microtin::exact::step_of(placement.x) * frame.west;
      if (at.size() < 2) continue;
      const double step = at[1] - at[0];
      const double digit = step / std::pow(10, std::floor(std::log10(step) + 1e-6));
      CHECK(
          (std::abs(digit - 1) < 1e-5 || std::abs(digit - 2) < 1e-5 || std::abs(digit - 5) < 1e-5));
      CHECK(step / pixel >= 69.9);
      CHECK(step / pixel <= 400);
      for (const double value : at) {
        CHECK(std::abs(value / step - std::round(value / step)) <
              1e-4 * std::max(1.0, pixel / step));
      }
      CHECK(at.front() - step < west);
      CHECK(at.back() + step > west + width * pixel);
    }
  }
}

TEST_CASE("frame: numbers are outside the map, in the room for them") {
  for (const double side : {10.0, 63.0, 200.0, 700.0}) {
    for (const Unit unit : {Unit::kMetre, Unit::kDegree}) {
      const MapFrame frame = map_of(side, side);
      Recorder drawn;
      draw_coordinates(drawn, frame, placed(-400, 700, 3, 10), unit, 2);
      if (side > 200) CHECK(drawn.strokes > 50);
      if (drawn.strokes == 0) continue;
      CHECK(drawn.left >= frame.box.left - 2 * kFrameRoom - 2 * 2);
      CHECK(drawn.top >= frame.box.top - 2 * kFrameRoom - 2 * 2);
      CHECK(drawn.right <= frame.box.left + side + 2 * 10);
      CHECK(drawn.bottom <= frame.box.top + side);
    }
  }
}

TEST_CASE("frame: the north arrow is in the map, if there is room") {
  Recorder small, large;
  draw_north_arrow(small, {0, 0, 200, 60}, 1);
  CHECK(small.strokes == 0);
  draw_north_arrow(large, {50, 50, 200, 64}, 1);
  CHECK(large.strokes > 0);
  CHECK(large.left > 150);
  CHECK(large.right < 250);
  CHECK(large.top > 50);
  CHECK(large.bottom < 114);
}
