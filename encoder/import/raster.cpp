// SPDX-License-Identifier: MIT
// What the readers of rasters share: marks of voids, places of cells, counts of posts.
#include "encoder/import/raster.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/exact/fraction.hpp"

namespace microtin::importing {
namespace {

// As printf writes what is not a number.
bool is_nan(std::string_view word) {
  if (!word.empty() && (word[0] == '-' || word[0] == '+')) word.remove_prefix(1);
  return lower_case(std::string(word.substr(0, 3))) == "nan" &&
         (word.size() == 3 || word[3] == '(');
}

bool can_be_height(double value) {
  return std::abs(value) < static_cast<double>(kLargestNumber);
}

// Two numbers that no height can have, of which one may be rounded, or infinite for the largest.
bool is_same_mark(double a, double b) {
  if (can_be_height(a) || can_be_height(b) || std::isnan(a) || std::isnan(b)) return false;
  constexpr double kMost = std::numeric_limits<double>::max(), kAlike = 1e-3;
  const double x = std::clamp(a, -kMost, kMost), y = std::clamp(b, -kMost, kMost);
  return std::signbit(x) == std::signbit(y) && std::abs(x - y) <= kAlike * std::abs(x);
}

// What the last digit of a number counts: 0.01 in 5.25, 100 in 5.25e4.
double last_place(std::string_view word) {
  const size_t e = std::min(word.find_first_of("eE"), word.size());
  int exponent = 0;
  if (e < word.size()) {
    std::string_view digits = word.substr(e + 1);
    if (!digits.empty() && digits[0] == '+') digits.remove_prefix(1);
    std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
  }
  const size_t point = word.substr(0, e).find('.');
  const int decimals = point == word.npos ? 0 : static_cast<int>(e - point) - 1;
  return std::pow(10.0, exponent - decimals);
}

// Whether a word says a float, to as many digits as it has.
bool is_image(std::string_view word, double number) {
  const double rounded = static_cast<float>(number);
  return std::abs(number - rounded) <= 0.5 * last_place(word);
}

}  // namespace

std::optional<double> number_of_any_size(std::string_view word) {
  if (!word.empty() && word[0] == '+') word.remove_prefix(1);
  if (const auto number = real_number(word)) return number;
  if (parse_decimal(word)) return 0;  // near it
  const size_t e = std::min(word.find_first_of("eE"), word.size());
  const auto digits = real_number(word.substr(0, e));
  if (!digits || e == word.size()) return std::nullopt;
  std::string_view exponent = word.substr(e);
  exponent.remove_prefix(exponent.substr(1, 1) == "+" ? 2 : 1);
  const bool is_huge = !exponent.empty() && exponent.find_first_not_of("0123456789") == word.npos;
  if (!is_huge) return std::nullopt;
  return std::copysign(std::numeric_limits<double>::infinity(), *digits);
}

NoData::NoData(std::string_view word) {
  const std::optional<double> number = number_of_any_size(word);
  if (is_nan(word) || !number) return;
  value_ = *number;
  text_ = word;
}

bool NoData::marks(float cell) const {
  if (std::isnan(cell) || is_same_mark(value_, cell)) return true;
  return can_be_height(value_) && cell == static_cast<float>(value_);
}

bool NoData::marks(double cell) const {
  if (std::isnan(cell) || cell == value_ || is_same_mark(value_, cell)) return true;
  if (!can_be_height(value_) || !can_be_height(cell)) return false;
  // A float that was widened, of the decimal that the value is.
  const auto narrow = static_cast<float>(value_);
  return cell == narrow && shortest_decimal(narrow) == shortest_decimal(value_);
}

bool NoData::marks(std::string_view word) const {
  if (is_nan(word)) return true;
  if (text_.empty()) return false;
  if (word == text_) return true;
  const std::optional<double> number = number_of_any_size(word);
  if (!number) return false;
  if (!can_be_height(*number) || !can_be_height(value_)) return is_same_mark(value_, *number);
  if (*number == value_) return parse_decimal(word) == parse_decimal(text_);
  return static_cast<float>(*number) == static_cast<float>(value_) && is_image(word, *number) &&
         is_image(text_, value_);
}

namespace {

Decimal place_of(double value) {
  const std::optional<Decimal> place = shortest_decimal(value, kPlaceDecimals);
  if (!place) throw Error("a number is out of range");
  return *place;
}

}  // namespace

bool runs_east(const std::array<double, 6>& transform) {
  constexpr double kNoSkew = 1e-9;
  const auto& [west, width, skew_by_row, north, skew_by_column, height] = transform;
  return width > 0 && std::abs(skew_by_row) <= kNoSkew * width &&
         std::abs(skew_by_column) <= kNoSkew * std::abs(height);
}

Axis axis_of_cells_from(double corner, double size, uint32_t cells) {
  const Decimal length = place_of(std::abs(size));
  if (length.mantissa == 0)
    throw Error("cells have no extent; give them a width and a height above 0");
  return axis_of_cells(place_of(corner), length, size > 0 ? 1 : 1 - 2 * int64_t{cells});
}

}  // namespace microtin::importing
