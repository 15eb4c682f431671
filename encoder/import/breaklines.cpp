// SPDX-License-Identifier: MIT
// Reads breaklines.
#include "encoder/import/breaklines.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/files/input.hpp"
#include "encoder/import/cloud.hpp"
#include "encoder/import/text.hpp"

namespace microtin::importing {
namespace {

constexpr std::size_t kNoColumn = SIZE_MAX;

std::string lower_case(std::string_view field) {
  std::string name(field);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return name;
}

bool names_lines(std::string_view field) {
  const std::string name = lower_case(field);
  return name == "line" || name == "line_id" || name == "id" || name == "fid";
}

bool names_classes(std::string_view field) {
  return lower_case(field) == "class";
}

// A class, which an empty text does not state.
LineClass class_at(const std::string& place, std::string_view name) {
  if (name.empty()) return LineClass::kOther;
  const std::optional<LineClass> kind = line_class_named(lower_case(name));
  if (kind) return *kind;
  throw Error(place + ": '" + std::string(name) + "' is not a class of lines; use one of " +
              names_of_line_classes());
}

// Reads text with a position on each line.
class TextLineReader {
 public:
  explicit TextLineReader(const std::string& name) : name_(name) {}

  BreaklineFile read(std::string_view text) {
    std::string_view rest = without_mark(text);
    while (!rest.empty()) read_text_line(take_line(rest));
    end();
    return std::move(lines_);
  }

  const StatedSystem& stated() const { return stated_; }

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
    for (std::string_view& field : fields_) field = without_quotes(field);
    if (!is_begun_ && std::none_of(fields_.begin(), fields_.end(), is_number)) {
      is_begun_ = true;
      read_names();
      return;
    }
    is_begun_ = true;
    expect_decimal_points(line);
    read_position();
  }

  // Commas are between the columns, or between these and their decimals.
  void expect_decimal_points(std::string_view line) const {
    if (line.find(';') != line.npos || line.find(',') == line.npos) return;
    const std::size_t columns = fields_.size() - (fields_.back().empty() ? 1 : 0);
    if (names_ != 0 && columns > names_) {
      fail(std::to_string(columns) + " columns under " + std::to_string(names_) +
           " names; decimals are written with a point");
    }
    if (names_ == 0 && columns > 3 && has_torn_decimals(line, fields_)) {
      fail("a number after a comma begins with 0, as decimals do, which are written with a point");
    }
  }

  static bool is_number(std::string_view field) { return parse_decimal(field).has_value(); }

  void read_names() {
    column_.fill(kNoColumn);
    line_column_ = class_column_ = kNoColumn;
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (const std::optional<PointColumn> column = column_named(fields_[i])) {
        if (column_[column->axis] == kNoColumn) take(*column, i);
      } else if (line_column_ == kNoColumn && names_lines(fields_[i])) {
        line_column_ = i;
      } else if (class_column_ == kNoColumn && names_classes(fields_[i])) {
        class_column_ = i;
      }
    }
    if (column_[0] == kNoColumn || column_[1] == kNoColumn) {
      const bool may_be_numbers = fields_[0].find_first_of("0123456789") == 0;
      if (may_be_numbers) fail(not_a_number(fields_[0]));
      fail("no columns are named as x and y: name them, or begin the line with #");
    }
    names_ = fields_.size();
  }

  // The column of an axis, and what its name states.
  void take(const PointColumn& column, std::size_t place) {
    column_[column.axis] = place;
    if (column.axis == 2) {
      stated_.vertical = column.unit;
      stated_.is_depth = column.is_depth;
    } else if (column.is_degree) {
      stated_.horizontal.unit = Unit::kDegree;
    } else if (column.unit.is_stated()) {
      stated_.horizontal = column.unit;
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
    read_class();
    RealPoint point{number_at(column_[0]), number_at(column_[1])};
    const bool has_height = column_[2] < fields_.size() && !fields_[column_[2]].empty();
    if (has_height) point.z = number_at(column_[2]);
    if (!line_.empty() && line_.front().z.has_value() != has_height) {
      fail("a line has positions with and without a height; give all of them one, or none");
    }
    line_.push_back(point);
  }

  void read_class() {
    if (class_column_ >= fields_.size()) return;
    const LineClass kind = class_at(name_ + ':' + std::to_string(number_), fields_[class_column_]);
    if (kind == class_) return;
    end();
    class_ = kind;
  }

  void end() {
    if (line_.size() == 1) fail("a line before this place has a single position; it needs two");
    if (!line_.empty()) {
      lines_.lines.push_back(std::move(line_));
      lines_.classes.push_back(class_);
    }
    line_.clear();
  }

  const std::string& name_;
  std::size_t number_ = 0;
  std::vector<std::string_view> fields_;
  bool is_begun_ = false;
  std::array<std::size_t, 3> column_ = {0, 1, 2};
  std::size_t line_column_ = 3, class_column_ = kNoColumn;
  std::size_t names_ = 0;  // of columns
  StatedSystem stated_;
  std::string line_name_;
  RealLine line_;
  LineClass class_ = LineClass::kOther;
  BreaklineFile lines_;
};

BreaklineFile lines_of(std::vector<Feature> features) {
  BreaklineFile all;
  for (Feature& feature : features) {
    const LineClass kind = class_at(feature.place_of_class, feature.line_class);
    std::move(feature.lines.begin(), feature.lines.end(), std::back_inserter(all.lines));
    for (RealRings& polygon : feature.polygons) {
      std::move(polygon.begin(), polygon.end(), std::back_inserter(all.lines));
    }
    all.classes.resize(all.lines.size(), kind);
  }
  return all;
}

// Where all positions of a line are one, there is no line.
bool is_single_place(const RealLine& line) {
  return std::all_of(line.begin(), line.end(), [&](const RealPoint& p) {
    return p.x == line.front().x && p.y == line.front().y;
  });
}

BreaklineFile without_single_places(BreaklineFile&& all) {
  BreaklineFile some;
  for (std::size_t i = 0; i < all.lines.size(); ++i) {
    if (is_single_place(all.lines[i])) continue;
    some.lines.push_back(std::move(all.lines[i]));
    some.classes.push_back(all.classes[i]);
  }
  return some;
}

bool is_text(const std::string& path, const FeatureFiles& files) {
  return !files.has_features(path) && !files.is_for_gdal(path);
}

BreaklineFile lines_of_text(const std::string& path, const FeatureFiles& files) {
  TextLineReader reader(path);
  BreaklineFile lines = reader.read(read_file(path));
  files.note(path, reader.stated(), beyond_earth(lines.lines));
  return lines;
}

}  // namespace

void note_breaklines(const std::string& path, const FeatureFiles& files) {
  if (files.is_noted(path) || !is_regular_file(path)) return;
  if (is_text(path, files)) {
    lines_of_text(path, files);
  } else {
    files.read(path);
  }
}

BreaklineFile read_breaklines(const std::string& path, const FeatureFiles& files) {
  BreaklineFile all = without_single_places(is_text(path, files) ? lines_of_text(path, files)
                                                                 : lines_of(files.read(path)));
  const std::vector<RealLine>& lines = all.lines;
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
  return all;
}

}  // namespace microtin::importing
