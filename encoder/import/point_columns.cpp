// SPDX-License-Identifier: MIT
#include "encoder/import/point_columns.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "encoder/base/suffix.hpp"

namespace microtin::importing {
namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";

std::string plain_name(std::string_view field) {
  std::string name = lower_case(std::string(field.substr(0, field.find_first_of("([,;"))));
  const auto is_mark = [](char c) { return c == '"' || c == '/'; };
  name.erase(std::remove_if(name.begin(), name.end(), is_mark), name.end());
  name.erase(0, std::min(name.find_first_not_of(kBlanks), name.size()));
  return name.substr(0, name.find_first_of(kBlanks));
}

std::string_view bracketed(std::string_view field) {
  const size_t open = field.find_first_of("(["), close = field.find_last_of(")]");
  if (open == field.npos || close == field.npos || close < open) return {};
  return field.substr(open + 1, close - open - 1);
}

bool is_known(const StatedUnit& unit) {
  return unit.unit != Unit::kUnknown || length_named(unit.other) != nullptr;
}

std::optional<PointColumn> plain_column(std::string_view name) {
  struct Name {
    std::string_view text;
    PointColumn column;
  };
  static const std::array<Name, 26> names = {
      {{"x", {0, false}},        {"y", {1, false}},          {"z", {2, false}},
       {"easting", {0, false}},  {"northing", {1, false}},   {"height", {2, false}},
       {"east", {0, false}},     {"north", {1, false}},      {"elevation", {2, false}},
       {"lon", {0, true}},       {"lat", {1, true}},         {"elev", {2, false}},
       {"long", {0, true}},      {"latitude", {1, true}},    {"ele", {2, false}},
       {"longitude", {0, true}}, {"altitude", {2, false}},   {"alt", {2, false}},
       {"lng", {0, true}},       {"h", {2, false}},          {"point_x", {0, false}},
       {"point_y", {1, false}},  {"point_z", {2, false}},    {"e", {0, false}},
       {"n", {1, false}},        {"depth", {2, false, true}}}};
  for (const Name& known : names) {
    if (known.text == name) return known.column;
  }
  return std::nullopt;
}

}  // namespace

std::optional<PointColumn> column_named(std::string_view field) {
  const std::string name = plain_name(field);
  std::optional<PointColumn> column = plain_column(name);
  StatedUnit unit = unit_named(bracketed(field));
  for (size_t at = name.find('_'); !column && at != name.npos; at = name.find('_', at + 1)) {
    const StatedUnit behind = unit_named(std::string_view(name).substr(at + 1));
    if (!is_known(behind)) continue;
    column = plain_column(std::string_view(name).substr(0, at));
    unit = behind;
  }
  // Places may have any remark in brackets, such as a zone.
  const bool is_place = column && column->axis != 2;
  if (column && (is_known(unit) || !is_place) && !column->is_degree) column->unit = unit;
  return column;
}

}  // namespace microtin::importing
