#include <algorithm>

#include "encoder/error.hpp"
#include "encoder/import.hpp"
#include "encoder/import_text.hpp"

namespace microtin {
namespace {

// Splits a line at runs of blanks with at most one comma or semicolon in each; an empty field is
// kept, unless it is the last.
void split(std::string_view line, std::vector<std::string_view>& fields) {
  const auto skip_blanks = [&line] {
    while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
  };
  fields.clear();
  for (skip_blanks(); !line.empty(); skip_blanks()) {
    const size_t end = std::min(line.find_first_of(" \t\r\v\f,;"), line.size());
    fields.push_back(line.substr(0, end));
    line.remove_prefix(end);
    skip_blanks();
    if (!line.empty() && (line.front() == ',' || line.front() == ';')) line.remove_prefix(1);
  }
}

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
    PointCloud cloud;
    if (columns_ == 0) throw Error(name_ + ": holds no point");
    cloud.xy_decimals = xy_.decimals();
    cloud.z_decimals = z_.decimals();
    const std::vector<int64_t>&xy = xy_.mantissas(), &z = z_.mantissas();
    cloud.points.reserve(z.size());
    for (size_t i = 0; i < z.size(); ++i) cloud.points.push_back({xy[2 * i], xy[2 * i + 1], z[i]});
    return cloud;
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
      const bool good = value && (i < 2 ? xy_.add(*value) : i > 2 || z_.add(*value));
      if (!good) fail(quoted(fields_[i]) + " is not a number in range");
    }
    if (columns_ == 2) z_.add(Decimal{});
  }

  const std::string& name_;
  size_t line_ = 0;
  size_t columns_ = 0;  // 0 until the first point
  bool header_seen_ = false;
  std::vector<std::string_view> fields_;
  DecimalColumn xy_;  // x and y in turn, so that they share their decimals
  DecimalColumn z_;
};

}  // namespace

PointCloud import_points(const std::string& name, const std::string& text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  std::string_view rest = text;
  if (rest.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
    rest.remove_prefix(kByteOrderMark.size());
  }
  PointReader reader(name);
  while (!rest.empty()) {
    const size_t end = std::min(rest.find('\n'), rest.size());
    reader.read_line(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return reader.cloud();
}

}  // namespace microtin
