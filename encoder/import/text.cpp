// SPDX-License-Identifier: MIT
// Splits text into lines and fields, and reads their numbers.
#include "encoder/import/text.hpp"

#include <algorithm>
#include <charconv>
#include <new>

#include "encoder/base/error.hpp"

namespace microtin::importing {

void fail_at(const std::string& name, size_t line, const std::string& what) {
  throw Error(name + ":" + std::to_string(line) + ": " + what);
}

std::string quoted(std::string_view piece) {
  constexpr size_t kMost = 24;
  std::string text(piece.substr(0, kMost));
  for (char& c : text) {
    if (c < ' ' || c > '~') c = '?';
  }
  return '"' + text + (piece.size() > kMost ? "...\"" : "\"");
}

std::string remedy_for_commas(std::string_view piece) {
  return piece.find(',') == piece.npos ? "" : "; decimals are written with a point";
}

std::string not_a_number(std::string_view word) {
  return quoted(word) + " is not a number in range" + remedy_for_commas(word);
}

std::string_view without_quotes(std::string_view field) {
  const bool is_quoted = field.size() > 1 && field.front() == '"' && field.back() == '"';
  return is_quoted ? field.substr(1, field.size() - 2) : field;
}

bool has_torn_decimals(std::string_view line, const std::vector<std::string_view>& fields) {
  if (line.find(',') == line.npos || line.find('.') != line.npos) return false;
  return std::any_of(fields.begin() + 1, fields.end(), [](std::string_view field) {
    return field.size() > 1 && field[0] == '0' &&
           field.find_first_not_of("0123456789") == field.npos;
  });
}

std::string not_a_height(double value) {
  char digits[32];
  const std::string text(
      digits,
      std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 17).ptr);
  return text +
         " is not a height in range: if it marks voids, declare it: NaN in an array, "
         "else \"gdal_translate -a_nodata " +
         text + '"';
}

bool DecimalRange::add(Decimal value) {
  if (value.decimals > decimals_) {
    largest_ *= power_of_ten(value.decimals - decimals_);
    if (largest_ > kLargestNumber) return false;
    decimals_ = value.decimals;
  }
  largest_ = std::max(largest_, magnitude(mantissa_at(value, decimals_)));
  return largest_ <= kLargestNumber;
}

bool DecimalColumn::add(Decimal value) {
  const int before = range_.decimals();
  if (!range_.add(value)) return false;
  const int64_t factor = power_of_ten(range_.decimals() - before);
  for (size_t i = 0; factor != 1 && i < mantissas_.size(); ++i) {
    if (mantissas_[i] != kVoidHeight) mantissas_[i] *= factor;
  }
  mantissas_.push_back(static_cast<int64_t>(mantissa_at(value, range_.decimals())));
  return true;
}

void DecimalColumn::reserve(size_t count) {
  if (count > mantissas_.max_size()) throw std::bad_alloc();
  mantissas_.reserve(count);
}

PointCloud PointColumns::take() {
  PointCloud cloud;
  cloud.xy_decimals = xy_.decimals();
  cloud.z_decimals = z_.decimals();
  const std::vector<int64_t>&xy = xy_.mantissas(), &z = z_.mantissas();
  cloud.points.reserve(z.size());
  for (size_t i = 0; i < z.size(); ++i) cloud.points.push_back({xy[2 * i], xy[2 * i + 1], z[i]});
  return cloud;
}

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

void split_at(char separator, std::string_view line, std::vector<std::string_view>& fields) {
  const auto skip_blanks = [&line] {
    while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
  };
  fields.clear();
  for (bool more = true; more;) {
    skip_blanks();
    bool in_quotes = false;
    size_t end = 0;
    for (; end < line.size() && (in_quotes || line[end] != separator); ++end) {
      if (line[end] == '"' && line[0] == '"') in_quotes = !in_quotes;
    }
    std::string_view field = line.substr(0, end);
    while (!field.empty() && is_blank(field.back())) field.remove_suffix(1);
    fields.push_back(field);
    more = end < line.size();
    line.remove_prefix(std::min(end + 1, line.size()));
  }
}

void split_at_blanks(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (size_t at = 0; at < line.size();) {
    const size_t begin = at;
    while (at < line.size() && !is_blank(line[at])) ++at;
    if (at != begin) fields.push_back(line.substr(begin, at - begin));
    while (at < line.size() && is_blank(line[at])) ++at;
  }
}

std::string_view without_mark(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  return text.substr(text.substr(0, kByteOrderMark.size()) == kByteOrderMark ? 3 : 0);
}

std::string_view take_line(std::string_view& text) {
  const size_t end = std::min(text.find_first_of("\r\n"), text.size());
  const std::string_view line = text.substr(0, end);
  const size_t end_bytes = text.substr(end, 2) == "\r\n" ? 2 : 1;
  text.remove_prefix(std::min(end + end_bytes, text.size()));
  return line;
}

}  // namespace microtin::importing
