// SPDX-License-Identifier: MIT
// What lines of a terrain are: ridges, rivers, dams and others.
#ifndef MICROTIN_ENCODER_TERRAIN_LINE_CLASS_HPP
#define MICROTIN_ENCODER_TERRAIN_LINE_CLASS_HPP

#include <cstddef>
#include <cstdint>
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

// "ridge"; "other" for an unknown class.
std::string_view name_of(LineClass kind);

// Nothing if there is no class of that name.
std::optional<LineClass> line_class_named(std::string_view name);

// The names of all classes, with commas.
std::string names_of_line_classes();

// Vertices of a mesh, each with an edge to the next one. The first is also the last of a closed
// line.
struct MarkedLine {
  LineClass kind = LineClass::kOther;
  std::vector<uint32_t> vertices;
};

}  // namespace microtin::terrain

#endif
