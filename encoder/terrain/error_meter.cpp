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

namespace {

// The root of the mean of `count` squares, rounded up. At most 2^92.
Wide root_of_mean(const SquareSum& sum, int64_t count) {
  Wide low = -1, high = Wide{1} << (2 * kHalf);  // low^2 * count < sum <= high^2 * count
  while (high - low > 1) {
    const Wide middle = low + (high - low) / 2;
    SquareSum all;
    all.add(middle, count);
    (sum <= all ? high : low) = middle;
  }
  return high;
}

}  // namespace

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
  largest_ = std::max(largest_, billionths);
  if (below > 0) deepest_ = std::max(deepest_, billionths);
  squares_.add(billionths, 1);
  sum_ += below > 0 ? -billionths : billionths;
  ++count_;
  return -static_cast<double>(below) / static_cast<double>(common_);
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
  return make_decimal_up(root_of_mean(squares_, count_), kMaxDecimals);
}

}  // namespace microtin::terrain
