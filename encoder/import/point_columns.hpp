// SPDX-License-Identifier: MIT
// What the names of columns of points say: which coordinate it is, in which unit, and which way up.
#ifndef MICROTIN_ENCODER_IMPORT_POINT_COLUMNS_HPP
#define MICROTIN_ENCODER_IMPORT_POINT_COLUMNS_HPP

#include <cstddef>
#include <optional>
#include <string_view>

#include "encoder/exact/units.hpp"
#include "encoder/layers.hpp"

namespace microtin::importing {

struct PointColumn {
  size_t axis = 0;  // 0 .. 2
  bool is_degree = false;
  bool is_depth = false;
  StatedUnit unit = {};  // from brackets, Height [ft], or behind an underscore, z_ft
};

// The first word counts, in any case, without quotes and the slashes that CloudCompare begins with.
// Nothing if it names no coordinate.
std::optional<PointColumn> column_named(std::string_view field);

}  // namespace microtin::importing

#endif
