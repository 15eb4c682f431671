#include "encoder/map_frame.hpp"

namespace microtin {
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

// Metres in a degree of longitude and of latitude: series for the ellipsoid WGS 84.
Spot metres_in_degree(double latitude) {
  constexpr double kRadian = 0.017453292519943295;
  const double angle = latitude * kRadian;
  return {111412.84 * std::cos(angle) - 93.5 * std::cos(3 * angle),
          111132.92 - 559.82 * std::cos(2 * angle) + 1.175 * std::cos(4 * angle)};
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
      const double latitude = offset_of(model.placement.y) + y * middle;
      const Spot metres = metres_in_degree(std::clamp(latitude, -89.0, 89.0));
      return {x * metres.x, y * metres.y, "m"};
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

}  // namespace microtin
