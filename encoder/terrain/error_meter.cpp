// SPDX-License-Identifier: MIT
// Errors in billionths, in wide integers.
#include "encoder/terrain/error_meter.hpp"

#include <algorithm>
#include <cstdint>

namespace microtin::terrain {
namespace {

constexpr int64_t kBillion = 1000000000;
constexpr int kHalf = 46;  // bits
constexpr Wide kHalfMask = (Wide{1} << kHalf) - 1;

// Rounds down.
Wide shifted(Wide number) {
  return (number - (number & kHalfMask)) / (Wide{1} << kHalf);
}

}  // namespace

void SquareSum::add(Wide number, Wide times) {
  const Wide high = shifted(number), low = number & kHalfMask;
  high_ += high * high * times;
  middle_ += high * low * times;
  low_ += low * low * times;
}

bool SquareSum::operator<=(const SquareSum& other) const {
  // other - this, carried from part to part; what the parts keep is not negative.
  const Wide low = other.low_ - low_;
  const Wide middle = 2 * (other.middle_ - middle_) + shifted(low);
  return other.high_ - high_ + shifted(middle) >= 0;
}

Wide SquareSum::root_of_mean(Wide count, Wide largest) const {
  Wide low = -1, high = largest;  // low^2 * count < sum <= high^2 * count
  while (high - low > 1) {
    const Wide middle = low + (high - low) / 2;
    SquareSum all;
    all.add(middle, count);
    (*this <= all ? high : low) = middle;
  }
  return high;
}

ErrorMeter::ErrorMeter(const Axis& source, const Axis& lattice)
    : to_common_(static_cast<Wide>(lattice.denominator) * 65536),
      offset_(Wide{lattice.offset} * 65536),
      step_(static_cast<Wide>(lattice.numerator)),
      from_common_(static_cast<Wide>(source.denominator)),
      common_(to_common_ * from_common_) {}

double ErrorMeter::add(int64_t number, int32_t answer) {
  const Wide below = number * to_common_ - from_common_ * (offset_ + step_ * answer);
  const Wide error = magnitude(below);
  const Wide billionths =
      error / common_ * kBillion + ceil_divide(error % common_ * kBillion, common_);
  count(billionths, below > 0);
  return -static_cast<double>(below) / static_cast<double>(common_);
}

// In parts of a unit that source and lattice have in common, the surface is below by whole + rest /
// under. Both go into the billionths, which are rounded up once.
double ErrorMeter::add(int64_t number, const ExactHeight& height) {
  const Wide common = from_common_ * (to_common_ / 65536), base = offset_ / 65536;
  const auto [over, over_rest] = multiply_divide(from_common_ * step_, height.above, height.under);
  Wide whole = number * (to_common_ / 65536) - from_common_ * (base + step_ * height.base) - over;
  Wide rest = height.under - over_rest;
  whole += rest == height.under ? 0 : -1;
  rest = rest == height.under ? 0 : rest;
  const bool is_below = whole > 0 || (whole == 0 && rest != 0);
  if (whole < 0) {
    whole = rest == 0 ? -whole : -whole - 1;
    rest = rest == 0 ? 0 : height.under - rest;
  }
  const auto [fine, fine_rest] = multiply_divide(kBillion, rest, height.under);
  const Wide in_part = whole % common * kBillion + fine + (fine_rest != 0 ? 1 : 0);
  count(whole / common * kBillion + ceil_divide(in_part, common), is_below);
  const double away =
      (static_cast<double>(whole) + static_cast<double>(rest) / static_cast<double>(height.under)) /
      static_cast<double>(common);
  return is_below ? -away : away;
}

void ErrorMeter::count(Wide billionths, bool is_below) {
  largest_ = std::max(largest_, billionths);
  if (is_below) deepest_ = std::max(deepest_, billionths);
  squares_.add(billionths, 1);
  sum_ += is_below ? -billionths : billionths;
  ++count_;
}

void ErrorMeter::tell(const std::optional<Decimal>& bound, Verification& found) const {
  found.max_error = make_decimal_up(largest_, kMaxDecimals);
  found.max_below = make_decimal_up(deepest_, kMaxDecimals);
  found.rms_error = root_mean_square();
  found.mean_error = mean();
  found.within_bound = !bound || found.max_error <= *bound;
}

Decimal ErrorMeter::mean() const {
  return count_ == 0 ? Decimal{} : make_decimal_nearest(round_divide(sum_, count_), kMaxDecimals);
}

Decimal ErrorMeter::root_mean_square() const {
  if (count_ == 0) return {};
  return make_decimal_up(squares_.root_of_mean(count_, largest_), kMaxDecimals);
}

}  // namespace microtin::terrain
