// SPDX-License-Identifier: MIT
// The names of classes of lines.
#include "encoder/terrain/line_class.hpp"

#include <algorithm>
#include <iterator>

namespace microtin::terrain {
namespace {

// From class 1 on.
constexpr std::string_view kClassNames[] = {"other", "ridge",   "valley", "water",
                                            "cliff", "dam",     "wall",   "building",
                                            "road",  "railway", "runway", "border"};

}  // namespace

std::string_view name_of(LineClass kind) {
  const auto number = static_cast<std::size_t>(kind);
  return kClassNames[number <= std::size(kClassNames) ? number - 1 : 0];
}

std::optional<LineClass> line_class_named(std::string_view name) {
  const auto* const at = std::find(std::begin(kClassNames), std::end(kClassNames), name);
  if (at == std::end(kClassNames)) return std::nullopt;
  return static_cast<LineClass>(1 + (at - std::begin(kClassNames)));
}

std::string names_of_line_classes() {
  std::string names;
  for (const std::string_view name : kClassNames) {
    names += (names.empty() ? "" : ", ") + std::string(name);
  }
  return names;
}

}  // namespace microtin::terrain
