// SPDX-License-Identifier: MIT
// Points as text, one a line.
#include <algorithm>

#include "encoder/base/error.hpp"
#include "encoder/import/import.hpp"
#include "encoder/import/text.hpp"

namespace microtin::importing {
namespace {

class PointReader {
 public:
  explicit PointReader(const std::string& name) : name_(name) {}

  void read_line(std::string_view line) {
    ++line_;
    split(line, fields_);
    if (fields_.empty() || line[line.find_first_not_of(" \t\r\v\f")] == '#') return;
    if (line.find(',') != line.npos && line.find(';') != line.npos) {
      fail("commas and semicolons are mixed; decimals are written with a point");
    }
    const bool first = !header_seen_ && columns_ == 0;
    if (first && is_header()) return check_header();
    read_point();
  }

  PointCloud cloud() {
    if (points_.empty()) throw Error(name_ + ": holds no point");
    return points_.take();
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { fail_at(name_, line_, what); }

  bool is_header() const {
    return std::none_of(fields_.begin(), fields_.end(),
                        [](std::string_view field) { return parse_decimal(field).has_value(); });
  }

  // Names may be any, but x, y and z must be where they are looked for.
  void check_header() {
    constexpr std::string_view kOrder = "xyz";
    header_seen_ = true;
    for (size_t i = 0; i < fields_.size(); ++i) {
      std::string_view field = fields_[i];
      if (field.size() == 3 && field.front() == '"') field = field.substr(1, 1);
      if (field.size() != 1) continue;
      const size_t wanted = kOrder.find(lower_case(std::string(field)));
      if (wanted != kOrder.npos && wanted != i) fail("the first columns must be x, y and z");
    }
  }

  void read_point() {
    if (columns_ == 0) columns_ = fields_.size();
    if (fields_.size() < 2) fail("a point needs two or three numbers");
    if (fields_.size() != columns_) {
      fail(std::to_string(fields_.size()) + " columns after lines of " + std::to_string(columns_));
    }
    for (size_t i = 0; i < columns_; ++i) {
      const std::optional<Decimal> value = parse_decimal(fields_[i]);
      const bool good = value && (i > 2 || points_.add(i, *value));
      if (!good) fail(quoted(fields_[i]) + " is not a number in range");
    }
    if (columns_ == 2) points_.add(2, Decimal{});
  }

  const std::string& name_;
  size_t line_ = 0;
  size_t columns_ = 0;  // 0 until the first point
  bool header_seen_ = false;
  std::vector<std::string_view> fields_;
  PointColumns points_;
};

}  // namespace

PointCloud import_points(const std::string& name, const std::string& text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  std::string_view rest = text;
  if (rest.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
    rest.remove_prefix(kByteOrderMark.size());
  }
  PointReader reader(name);
  while (!rest.empty()) reader.read_line(take_line(rest));
  return reader.cloud();
}

}  // namespace microtin::importing
