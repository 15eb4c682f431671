// SPDX-License-Identifier: MIT
// What the readers of points share: names of columns, classes, and how many points a file holds.
#include "encoder/import/cloud.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/files/input.hpp"

namespace microtin::importing {
namespace {

constexpr std::string_view kBlanksOfLine = " \t\r\v\f";

std::string plain_name(std::string_view field) {
  std::string name = lower_case(std::string(field.substr(0, field.find_first_of("([,;"))));
  const auto is_mark = [](char c) { return c == '"' || c == '/'; };
  name.erase(std::remove_if(name.begin(), name.end(), is_mark), name.end());
  name.erase(0, std::min(name.find_first_not_of(kBlanksOfLine), name.size()));
  return name.substr(0, name.find_first_of(kBlanksOfLine));
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

namespace {

void append(std::string& list, const std::string& item) {
  list += (list.empty() ? "" : ", ") + item;
}

}  // namespace

void add(ClassCounts& sum, const ClassCounts& more) {
  for (size_t c = 0; c < sum.points.size(); ++c) sum.points[c] += more.points[c];
  sum.withheld += more.withheld;
}

std::string taken_text(const ClassCounts& counts, const ClassSet& taken) {
  std::string in, out;
  for (size_t c = 0; c < counts.points.size(); ++c) {
    if (counts.points[c] == 0) continue;
    std::string& list = taken[c] ? in : out;
    append(list, (list.empty() ? "class " : "") + std::to_string(c) + " (" +
                     std::to_string(counts.points[c]) + ")");
  }
  if (counts.withheld != 0) append(out, "withheld (" + std::to_string(counts.withheld) + ")");
  return "taken" + (in.empty() ? in : ": " + in) + (out.empty() ? out : "; left out: " + out);
}

namespace {

constexpr uint64_t kLookedAt = 65536;

uint64_t points_of_ply(const std::string& head) {
  const std::string element = "element vertex ";
  const size_t at = head.find(element);
  if (at == std::string::npos) return 0;
  uint64_t points = 0;
  for (size_t i = at + element.size(); i < head.size() && head[i] >= '0' && head[i] <= '9'; ++i) {
    if (points < UINT32_MAX) points = 10 * points + static_cast<uint64_t>(head[i] - '0');
  }
  return points;
}

uint64_t lines_of(const std::string& head, uint64_t bytes) {
  const auto lines = static_cast<uint64_t>(std::count(head.begin(), head.end(), '\n'));
  return head.empty()
             ? 0
             : static_cast<uint64_t>(static_cast<double>(bytes) * static_cast<double>(lines) /
                                     static_cast<double>(head.size()));
}

uint64_t points_in(const std::string& path, const std::string& suffix) {
  const std::unique_ptr<ByteSource> file = open_file(path);
  const std::vector<uint8_t> head = bytes_at(*file, 0, std::min(kLookedAt, file->size()));
  const std::string text(head.begin(), head.end());
  if (suffix == ".las" || suffix == ".laz") return points_of_las(ByteReader(path, text));
  return suffix == ".ply" ? points_of_ply(text) : lines_of(text, file->size());
}

}  // namespace

uint64_t points_expected(const std::string& path) {
  const std::string suffix = suffix_of(path);
  constexpr const char* kClouds[] = {".las", ".laz", ".ply", ".xyz", ".csv", ".txt", ".obj"};
  const bool is_cloud =
      std::find(std::begin(kClouds), std::end(kClouds), suffix) != std::end(kClouds);
  try {
    return is_cloud && is_regular_file(path) ? points_in(path, suffix) : 0;
  } catch (const Error&) {
    return 0;
  }
}

}  // namespace microtin::importing
