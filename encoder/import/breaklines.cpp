// SPDX-License-Identifier: MIT
// Reads breaklines.
#include "encoder/import/breaklines.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/files/input.hpp"
#include "encoder/import/cloud.hpp"
#include "encoder/import/geojson.hpp"
#include "encoder/import/text.hpp"

namespace microtin::importing {
namespace {

constexpr std::size_t kNoColumn = SIZE_MAX;

bool names_lines(std::string_view field) {
  std::string name(field);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return name == "line" || name == "line_id" || name == "id" || name == "fid";
}

// Reads text with a position on each line.
class TextLineReader {
 public:
  explicit TextLineReader(const std::string& name) : name_(name) {}

  std::vector<RealLine> read(std::string_view text) {
    std::string_view rest = without_mark(text);
    while (!rest.empty()) read_text_line(take_line(rest));
    end();
    return std::move(lines_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { fail_at(name_, number_, what); }

  void read_text_line(std::string_view line) {
    ++number_;
    const std::size_t first = line.find_first_not_of(" \t\r\v\f");
    if (first == line.npos) {
      end();
      return;
    }
    if (line[first] == '#') return;
    if (line.find(';') != line.npos) {
      split_at(';', line, fields_);
    } else if (line.find(',') != line.npos) {
      split_at(',', line, fields_);
    } else {
      split_at_blanks(line, fields_);
    }
    if (!is_begun_ && std::none_of(fields_.begin(), fields_.end(), is_number)) {
      is_begun_ = true;
      read_names();
      return;
    }
    is_begun_ = true;
    read_position();
  }

  static bool is_number(std::string_view field) { return parse_decimal(field).has_value(); }

  void read_names() {
    column_.fill(kNoColumn);
    line_column_ = kNoColumn;
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (const std::optional<PointColumn> column = column_named(fields_[i])) {
        if (column_[column->axis] == kNoColumn) column_[column->axis] = i;
      } else if (line_column_ == kNoColumn && names_lines(fields_[i])) {
        line_column_ = i;
      }
    }
    if (column_[0] == kNoColumn || column_[1] == kNoColumn) {
      fail("no columns are named as x and y: name them, or begin the line with #");
    }
  }

  Decimal number_at(std::size_t column) const {
    if (column >= fields_.size()) fail("a position needs an x and a y");
    const std::optional<Decimal> number = parse_decimal(fields_[column], kPlaceDecimals);
    if (!number) fail(not_a_number(fields_[column]));
    return *number;
  }

  void read_position() {
    if (line_column_ < fields_.size() && fields_[line_column_] != line_name_) {
      end();
      line_name_ = fields_[line_column_];
    }
    RealPoint point{number_at(column_[0]), number_at(column_[1])};
    const bool has_height = column_[2] < fields_.size() && !fields_[column_[2]].empty();
    if (has_height) point.z = number_at(column_[2]);
    if (!line_.empty() && line_.front().z.has_value() != has_height) {
      fail("a line has positions with and without a height; give all of them one, or none");
    }
    line_.push_back(point);
  }

  void end() {
    if (line_.size() == 1) fail("a line before this place has a single position; it needs two");
    if (!line_.empty()) lines_.push_back(std::move(line_));
    line_.clear();
  }

  const std::string& name_;
  std::size_t number_ = 0;
  std::vector<std::string_view> fields_;
  bool is_begun_ = false;
  std::array<std::size_t, 3> column_ = {0, 1, 2};
  std::size_t line_column_ = 3;
  std::string line_name_;
  RealLine line_;
  std::vector<RealLine> lines_;
};

std::vector<RealLine> lines_of_features(const std::string& path, const std::string& text) {
  std::vector<RealLine> lines;
  for (Feature& feature : import_geojson(path, text)) {
    std::move(feature.lines.begin(), feature.lines.end(), std::back_inserter(lines));
    for (RealRings& polygon : feature.polygons) {
      std::move(polygon.begin(), polygon.end(), std::back_inserter(lines));
    }
  }
  return lines;
}

// Where all positions of a line are one, there is no line.
bool is_single_place(const RealLine& line) {
  return std::all_of(line.begin(), line.end(), [&](const RealPoint& p) {
    return p.x == line.front().x && p.y == line.front().y;
  });
}

}  // namespace

std::vector<RealLine> read_breaklines(const std::string& path) {
  const std::string text = read_file(path);
  std::vector<RealLine> lines =
      is_geojson(path) ? lines_of_features(path, text) : TextLineReader(path).read(text);
  lines.erase(std::remove_if(lines.begin(), lines.end(), is_single_place), lines.end());
  if (lines.empty()) throw Error(path + ": has no line");
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool has_heights = lines[i].front().z.has_value();
    const bool is_mixed = std::any_of(lines[i].begin(), lines[i].end(), [&](const RealPoint& p) {
      return p.z.has_value() != has_heights;
    });
    if (!is_mixed) continue;
    throw Error(path + ": line " + std::to_string(i + 1) +
                " has positions with and without a height; give all of them one, or none");
  }
  return lines;
}

}  // namespace microtin::importing
