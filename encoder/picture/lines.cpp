// SPDX-License-Identifier: MIT
// Draws lines of a terrain.
#include "encoder/picture/lines.hpp"

#include <cstddef>

namespace microtin::picture {
namespace {

constexpr double kLineWidth = 1.6;  // units

Colour colour_of_line(LineClass kind) {
  switch (kind) {
    case LineClass::kRidge:
      return {0.43, 0.24, 0.10};
    case LineClass::kValley:
      return {0.13, 0.45, 0.40};
    case LineClass::kWater:
      return {0.07, 0.33, 0.72};
    case LineClass::kCliff:
      return {0.30, 0.30, 0.34};
    case LineClass::kDam:
      return {0.45, 0.12, 0.50};
    case LineClass::kWall:
    case LineClass::kBuilding:
      return {0.10, 0.10, 0.10};
    case LineClass::kRoad:
    case LineClass::kRailway:
      return {0.80, 0.33, 0.05};
    case LineClass::kRunway:
      return {0.72, 0.05, 0.20};
    case LineClass::kBorder:
      return {0.18, 0.42, 0.12};
    case LineClass::kOther:
      break;
  }
  return {0.78, 0.08, 0.08};
}

}  // namespace

void draw_marked_lines(Drawing& drawing, const MapFrame& frame, const SurfaceModel& model,
                       const std::vector<MarkedLine>& lines, double unit) {
  const auto spot_of = [&](uint32_t v) {
    const auto& place = model.vertices[v];
    return frame.in_picture(
        frame.spot(static_cast<double>(place[0]), static_cast<double>(place[1])));
  };
  for (const MarkedLine& line : lines) {
    for (std::size_t i = 1; i < line.vertices.size(); ++i) {
      drawing.stroke(spot_of(line.vertices[i - 1]), spot_of(line.vertices[i]), kLineWidth * unit,
                     colour_of_line(line.kind));
    }
  }
}

}  // namespace microtin::picture
