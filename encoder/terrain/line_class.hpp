// SPDX-License-Identifier: MIT
// What lines of a terrain are: ridges, rivers, dams and others.
#ifndef MICROTIN_ENCODER_TERRAIN_LINE_CLASS_HPP
#define MICROTIN_ENCODER_TERRAIN_LINE_CLASS_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/layers.hpp"

namespace microtin::terrain {

// The numbers of microtin_line_class, edge_marks.h. Others stand for unknown classes.
enum class LineClass : uint8_t {
  kOther = 1,
  kRidge,
  kValley,
  kWater,
  kCliff,
  kDam,
  kWall,
  kBuilding,
  kRoad,
  kRailway,
  kRunway,
  kBorder
};

constexpr std::size_t kLineClassNumbers = 16;

// From class 1 on.
inline constexpr std::string_view kLineClassNames[] = {"other", "ridge",   "valley", "water",
                                                       "cliff", "dam",     "wall",   "building",
                                                       "road",  "railway", "runway", "border"};

// "ridge"; "other" for an unknown class.
inline std::string_view name_of(LineClass kind) {
  const auto number = static_cast<std::size_t>(kind);
  return kLineClassNames[number <= std::size(kLineClassNames) ? number - 1 : 0];
}

// Nothing if there is no class of that name.
inline std::optional<LineClass> line_class_named(std::string_view name) {
  const auto* const at = std::find(std::begin(kLineClassNames), std::end(kLineClassNames), name);
  if (at == std::end(kLineClassNames)) return std::nullopt;
  return static_cast<LineClass>(1 + (at - std::begin(kLineClassNames)));
}

// The names of all classes, with commas.
inline std::string names_of_line_classes() {
  std::string names;
  for (const std::string_view name : kLineClassNames) {
    names += (names.empty() ? "" : ", ") + std::string(name);
  }
  return names;
}

// Vertices of a mesh, each with an edge to the next one. The first is also the last of a closed
// line.
struct MarkedLine {
  LineClass kind = LineClass::kOther;
  std::vector<uint32_t> vertices;
};

}  // namespace microtin::terrain

#endif
