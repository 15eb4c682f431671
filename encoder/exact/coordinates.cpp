// SPDX-License-Identifier: MIT
// Divides exactly, so that a coordinate prints with as many decimals as it has.
#include "encoder/exact/coordinates.hpp"

#include <algorithm>

#include "encoder/exact/wide.hpp"

namespace microtin::exact {
namespace {

uint64_t reduced_denominator(const Axis& axis) {
  const Wide denominator = static_cast<Wide>(axis.denominator);
  const Wide divisor = greatest_common_divisor(
      axis.offset, greatest_common_divisor(static_cast<Wide>(axis.numerator), denominator));
  return static_cast<uint64_t>(denominator / divisor);
}

}  // namespace

int decimals_of(const Axis& axis) {
  constexpr int kMost = 18, kOfEndless = 12;
  uint64_t denominator = reduced_denominator(axis);
  int twos = 0, fives = 0;
  for (; denominator % 2 == 0; denominator /= 2) ++twos;
  for (; denominator % 5 == 0; denominator /= 5) ++fives;
  const int decimals = std::max(twos, fives);
  return denominator == 1 && decimals <= kMost ? decimals : kOfEndless;
}

CoordinateText::CoordinateText(const Axis& axis)
    : axis_(axis), decimals_(decimals_of(axis)), scale_(power_of_ten(decimals_)) {}

std::string CoordinateText::operator()(int64_t number) const {
  const Wide numerator = axis_.offset + static_cast<Wide>(axis_.numerator) * number;
  const Wide denominator = static_cast<Wide>(axis_.denominator);
  const Wide size = magnitude(numerator);
  const Wide whole = size / denominator;
  // The remainder is below 2^40, the scale below 2^60. Rounding never carries: a denominator below
  // 2^40 leaves 1 - 1 / denominator at or below 0.9999999999991.
  const Wide fraction = round_divide(size % denominator * scale_, denominator);
  const bool negative = numerator < 0 && (whole != 0 || fraction != 0);
  const std::string behind_zero = to_string(make_decimal(fraction, decimals_)).substr(1);
  return (negative ? "-" : "") + std::to_string(static_cast<uint64_t>(whole)) + behind_zero;
}

size_t CoordinateText::longest(int64_t low, int64_t high) const {
  const auto whole = [this](int64_t number) {
    const std::string text = (*this)(number);
    return std::min(text.find('.'), text.size());
  };
  const size_t behind_point = decimals_ == 0 ? 0 : 1 + static_cast<size_t>(decimals_);
  return std::max(whole(low), whole(high)) + behind_point;
}

}  // namespace microtin::exact
