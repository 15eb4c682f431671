// SPDX-License-Identifier: MIT
#include "encoder/terrain/degrees.hpp"

#include <array>
#include <cmath>

#include "encoder/base/error.hpp"
#include "encoder/exact/coordinates.hpp"

namespace microtin::terrain {
namespace {

constexpr std::array<int64_t, 2> kMost = {360, 90};
constexpr const char* kRemedy =
    ": x is the longitude and y the latitude; exchange them, or give the coordinate system that "
    "they are in";

std::string beyond(size_t axis, const std::string& value) {
  return std::string(axis == 0 ? "longitude " : "latitude ") + value + " is beyond " +
         std::to_string(kMost[axis]) + " degrees";
}

// Whether a raster's column or row lies farther out than there may be one.
bool is_beyond(size_t axis, const Axis& posts, int64_t number) {
  constexpr double kRounding = 0.01;  // parts of a cell
  const double margin = step_of(posts) * (axis == 0 ? 1 + kRounding : kRounding);
  const double place = offset_of(posts) + step_of(posts) * static_cast<double>(number);
  return std::abs(place) > static_cast<double>(kMost[axis]) + margin;
}

}  // namespace

std::string beyond_degrees(size_t axis, Decimal value) {
  const Decimal size{value.mantissa < 0 ? -value.mantissa : value.mantissa, value.decimals};
  if (axis > 1 || size <= Decimal{kMost[axis], 0}) return "";
  return beyond(axis, to_string(value));
}

void expect_on_earth(const PointCloud& cloud) {
  const auto decimal = [&](int64_t number) { return make_decimal(number, cloud.xy_decimals); };
  const int64_t unit = power_of_ten(cloud.xy_decimals);
  for (size_t i = 0; i < cloud.points.size(); ++i) {
    const SourcePoint& p = cloud.points[i];
    for (const size_t axis : {size_t{0}, size_t{1}}) {
      const int64_t number = axis == 0 ? p.x : p.y;
      if (magnitude(number) <= Wide{kMost[axis]} * unit) continue;
      throw Error("point " + std::to_string(i + 1) + ", at x " + to_string(decimal(p.x)) + ", y " +
                  to_string(decimal(p.y)) + ": " + beyond_degrees(axis, decimal(number)) + kRemedy);
    }
  }
}

void expect_on_earth(const Raster& frame) {
  for (const size_t axis : {size_t{0}, size_t{1}}) {
    const Axis& posts = axis == 0 ? frame.x : frame.y;
    const int64_t count = axis == 0 ? frame.width : frame.height;
    for (const int64_t number : {int64_t{0}, count - 1}) {
      if (!is_beyond(axis, posts, number)) continue;
      std::string text = axis == 0 ? "column " : "row ";
      text += std::to_string(number + 1);
      text += axis == 0 ? " from the west: " : " from the south: ";
      throw Error(text + beyond(axis, CoordinateText(posts)(number)) + kRemedy);
    }
  }
}

}  // namespace microtin::terrain
