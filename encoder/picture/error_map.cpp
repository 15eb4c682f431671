// SPDX-License-Identifier: MIT
// Colours each place by its error, and finds the largest.
#include "encoder/picture/error_map.hpp"

#include <limits>

namespace microtin::picture {
namespace {

constexpr std::array<Colour, 3> kBelow = {
    {{0.96, 0.96, 0.95}, {0.50, 0.68, 0.84}, {0.10, 0.27, 0.53}}};
constexpr std::array<Colour, 3> kAbove = {
    {{0.96, 0.96, 0.95}, {0.92, 0.60, 0.45}, {0.62, 0.09, 0.12}}};
constexpr float kNotMeasured = std::numeric_limits<float>::quiet_NaN();

// The pixels with their middles in a range, at least the one that the range is in.
std::pair<uint32_t, uint32_t> pixels(double middle, double reach, uint32_t count) {
  const auto within = [count](double at) {
    return static_cast<uint32_t>(std::clamp<double>(at, 0, count));
  };
  constexpr double kSlack = 1e-6;  // rounding must not part neighbours
  const uint32_t first = within(std::ceil(middle - reach - 0.5 - kSlack));
  const uint32_t end = within(std::ceil(middle + reach - 0.5 + kSlack));
  if (first < end) return {first, end};
  const uint32_t own = std::min(within(std::floor(middle)), count - 1);
  return {own, own + 1};
}

double whole_steps(double cell) {
  return std::max(1.0, std::ceil(cell - 1e-9));
}

}  // namespace

Colour error_colour(double relative) {
  const auto& colours = relative < 0 ? kBelow : kAbove;
  const double at = 2 * std::min(1.0, std::abs(relative));
  return at < 1 ? mix(colours[0], colours[1], at) : mix(colours[1], colours[2], at - 1);
}

ErrorMap::ErrorMap(const MapFrame& frame, Spot cell)
    : frame_(frame),
      reach_{whole_steps(cell.x) / frame.x_step / 2, whole_steps(cell.y) / frame.y_step / 2},
      errors_(size_t{frame.columns()} * frame.rows(), kNotMeasured) {}

void ErrorMap::add(double x, double y, double above) {
  const Spot spot = frame_.spot(x, y);
  const auto [left, right] = pixels(spot.x, reach_.x, frame_.columns());
  const auto [top, bottom] = pixels(spot.y, reach_.y, frame_.rows());
  const auto error = static_cast<float>(above);
  for (uint32_t row = top; row < bottom; ++row) {
    for (uint32_t column = left; column < right; ++column) {
      float& old = errors_[size_t{row} * frame_.columns() + column];
      if (!(std::abs(old) >= std::abs(error))) old = error;
    }
  }
}

void ErrorMap::draw(Canvas& canvas, double scale) const {
  for (uint32_t row = 0; row < frame_.rows(); ++row) {
    for (uint32_t column = 0; column < frame_.columns(); ++column) {
      const double error = errors_[size_t{row} * frame_.columns() + column];
      if (std::isnan(error)) continue;
      canvas.blend(static_cast<uint32_t>(frame_.box.left) + column,
                   static_cast<uint32_t>(frame_.box.top) + row, error_colour(error / scale), 1);
    }
  }
}

}  // namespace microtin::picture
