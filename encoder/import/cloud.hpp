// SPDX-License-Identifier: MIT
// What the readers of points share: names of columns, classes, and how many points a file holds.
#ifndef MICROTIN_ENCODER_IMPORT_CLOUD_HPP
#define MICROTIN_ENCODER_IMPORT_CLOUD_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "encoder/exact/units.hpp"
#include "encoder/files/input.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

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

// What was taken of a laser scan, and what was left out.

void add(ClassCounts& sum, const ClassCounts& more);

// "taken: class 2 (812); left out: class 1 (240), withheld (13)".
std::string taken_text(const ClassCounts& counts, const ClassSet& taken);

// How large a cloud is, before it is read.

// About how many points a file holds: what the header of a .las, .laz or .ply says, or as many
// lines as there are in a text if all are as long as its first. 0 of other files, and of those that
// cannot be read, which reading tells.
uint64_t points_expected(const std::string& path);

// How many points the header of a LAS file says there are. Throws Error if it is cut off.
uint64_t points_of_las(const ByteReader& file);

}  // namespace microtin::importing

#endif
