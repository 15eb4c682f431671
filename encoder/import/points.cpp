// SPDX-License-Identifier: MIT
// Points as text, one a line.
#include <algorithm>
#include <array>
#include <optional>

#include "encoder/base/error.hpp"
#include "encoder/import/cloud.hpp"
#include "encoder/import/import.hpp"
#include "encoder/import/reference.hpp"
#include "encoder/import/text.hpp"
#include "encoder/terrain/degrees.hpp"

namespace microtin::importing {
namespace {

// Whether commas separate numbers, and blanks without a comma do, too: then one of them may be the
// mark of decimals.
bool has_mixed_separators(std::string_view line) {
  if (line.find(',') == line.npos) return false;
  bool has_bare_comma = false, has_bare_blank = false, after_comma = true, after_blank = false;
  for (const char c : line) {
    const bool comma = c == ',', blank = is_blank(c);
    if (!comma && !blank) {
      has_bare_comma = has_bare_comma || (after_comma && !after_blank);
      has_bare_blank = has_bare_blank || (after_blank && !after_comma);
      after_comma = after_blank = false;
    }
    after_comma = after_comma || comma;
    after_blank = after_blank || blank;
  }
  return has_bare_comma && has_bare_blank;
}

class TextPointReader {
 public:
  explicit TextPointReader(const std::string& name) : name_(name) {}

  void read_line(std::string_view line) {
    ++line_;
    split(line, fields_);
    if (fields_.empty() || line[line.find_first_not_of(" \t\r\v\f")] == '#') return;
    const bool first = !header_seen_ && columns_ == 0;
    if (first && is_header()) {
      split_names(line);
      return check_header();
    }
    split_values(line);
    check_columns(line);
    read_point();
  }

  PointCloud cloud() {
    if (points_.empty()) throw Error(name_ + ": holds no point");
    PointCloud cloud = points_.take();
    cloud.reference = reference_;
    return cloud;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { fail_at(name_, line_, what); }

  bool is_header() const {
    return std::none_of(fields_.begin(), fields_.end(),
                        [](std::string_view field) { return number_in(field).has_value(); });
  }

  // Between commas or semicolons names may hold blanks.
  void split_names(std::string_view line) {
    if (line.find_first_of(",;") == line.npos) return;
    separator_ = line.find(';') == line.npos ? ',' : ';';
    split_at(separator_, line, fields_);
    if (fields_.back().empty()) fields_.pop_back();
  }

  // By what separates the names, if there is any of it: so columns of text may hold all else.
  void split_values(std::string_view line) {
    if (separator_ != ' ' && line.find(separator_) != line.npos) {
      split_at(separator_, line, fields_);
      const bool ends_in_place = is_coordinate(names_ - 1) || fields_.size() > names_;
      if (fields_.back().empty() && ends_in_place) fields_.pop_back();
      return;
    }
    if (line.find(',') != line.npos && line.find(';') != line.npos) {
      fail("commas and semicolons are mixed; decimals are written with a point");
    }
    if (has_mixed_separators(line)) {
      fail("commas and blanks are mixed; decimals are written with a point");
    }
  }

  bool is_coordinate(size_t column) const {
    return std::find(axes_.begin(), axes_.end(), column) != axes_.end();
  }

  bool has_text() const {
    for (size_t i = 0; i < fields_.size(); ++i) {
      if (!is_coordinate(i) && !number_in(fields_[i])) return true;
    }
    return false;
  }

  void check_columns(std::string_view line) {
    if (columns_ == 0) columns_ = fields_.size();
    if (fields_.size() < 2) fail("a point needs two or three numbers");
    if (fields_.size() != columns_) {
      fail(std::to_string(fields_.size()) + " columns after lines of " + std::to_string(columns_));
    }
    if (names_ != 0) {
      check_names(separator_ == ',' && line.find(',') != line.npos);
    } else if (columns_ > 3 && has_torn_decimals(line, fields_)) {
      fail("a number after a comma begins with 0, as decimals do, which are written with a point");
    }
  }

  // Whether the columns may be what the names say. One more is common, of a header that names
  // coordinates alone; decimal commas make as many more as there are numbers, or fewer.
  void check_names(bool by_commas) const {
    const std::string under =
        std::to_string(columns_) + " columns under " + std::to_string(names_) + " names";
    if (columns_ < names_) {
      fail(under + ": a number is missing, or blanks in names need commas between them");
    }
    if (columns_ == 2 * names_) fail(under + "; decimals are written with a point");
    const bool names_others = names_ > 3 || !is_coordinate(names_ - 1);
    const bool too_many = columns_ > names_ + (names_others ? 0 : 1);
    if (by_commas && too_many) {
      fail(under + "; decimals are written with a point, and texts with commas between quotes");
    }
    if (columns_ != names_ && has_text()) {
      fail(under + ": texts with blanks need commas or semicolons between the columns");
    }
  }

  static std::optional<Decimal> number_in(std::string_view field) {
    return parse_decimal(without_quotes(field));
  }

  // Those of coordinates say where these are, others may be any. Latitudes are degrees.
  void check_header() {
    header_seen_ = true;
    std::array<std::optional<size_t>, 3> found;
    std::array<PointColumn, 3> columns;
    for (size_t i = 0; i < fields_.size(); ++i) {
      const std::optional<PointColumn> column = column_named(fields_[i]);
      if (!column) continue;
      PointColumn& known = columns[column->axis];
      std::optional<size_t>& place = found[column->axis];
      if (place && column->is_depth && !known.is_depth) continue;  // heights come before depths
      if (place && column->is_depth == known.is_depth) {
        fail(std::string("two columns are named as ") + "xyz"[column->axis]);
      }
      place = i;
      known = *column;
    }
    state_units(columns);
    if (!found[0] && !found[1] && !found[2]) {
      fail(
          "no column is named as x, y or z: name these, or begin the line with # if they are "
          "first");
    }
    names_ = fields_.size();
    for (size_t axis = 0; axis < 3; ++axis) axes_[axis] = found[axis].value_or(axis);
    const bool has_other = !found[2] && names_ > 2;  // where z would be
    if (!found[0] || !found[1] || has_other) {
      fail("the header names some of x, y and z: it must name all, or x and y alone");
    }
  }

  void state_units(const std::array<PointColumn, 3>& columns) {
    const auto& [x, y, z] = columns;
    if (x.unit.unit != y.unit.unit || x.unit.other != y.unit.other) {
      fail("x and y are in different units");
    }
    state_horizontal_unit(x.unit, reference_);
    if (x.is_degree || y.is_degree) reference_.horizontal_unit = Unit::kDegree;
    state_vertical_unit(z.unit, reference_);
    reference_.depths = z.is_depth;
  }

  void read_point() {
    for (size_t i = 0; names_ == 0 && i < columns_; ++i) {
      if (!number_in(fields_[i])) fail_on(fields_[i]);
    }
    for (size_t axis = 0; axis < 3; ++axis) {
      const size_t column = axes_[axis];
      const auto given = column < columns_ ? number_in(fields_[column]) : Decimal{};
      if (!given) fail_on(fields_[column]);
      const Decimal value = *given;
      if (reference_.horizontal_unit == Unit::kDegree) expect_degrees(axis, value);
      if (!points_.add(axis, value)) fail_on(fields_[column]);
    }
  }

  void expect_degrees(size_t axis, Decimal value) const {
    const std::string wrong = beyond_degrees(axis, value);
    if (!wrong.empty()) fail(wrong + ": name the columns as they are, x,y,z for others");
  }

  [[noreturn]] void fail_on(std::string_view field) const { fail(not_a_number(field)); }

  const std::string& name_;
  size_t line_ = 0;
  size_t columns_ = 0;    // 0 until the first point
  size_t names_ = 0;      // of columns, if coordinates are among them
  char separator_ = ' ';  // between these; blanks stand for themselves
  bool header_seen_ = false;
  std::vector<std::string_view> fields_;
  std::array<size_t, 3> axes_ = {0, 1, 2};  // columns of x, y and z
  Reference reference_;
  PointColumns points_;
};

}  // namespace

PointCloud import_points(const std::string& name, const std::string& text) {
  std::string_view rest = without_mark(text);
  TextPointReader reader(name);
  while (!rest.empty()) reader.read_line(take_line(rest));
  return reader.cloud();
}

}  // namespace microtin::importing
