// SPDX-License-Identifier: MIT
// Fits a terrain into a box, degrees corrected for its latitude.
#include "encoder/picture/map_frame.hpp"

#include <algorithm>
#include <cmath>

#include "encoder/export/degree.hpp"

namespace microtin::picture {
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

}  // namespace microtin::picture
