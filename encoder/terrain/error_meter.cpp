// SPDX-License-Identifier: MIT
// Errors in billionths, in wide integers.
#include "encoder/terrain/error_meter.hpp"

#include <algorithm>

namespace microtin::terrain {
namespace {

constexpr int64_t kBillion = 1000000000;

// Errors above a million units are squared without their last bits, so that 2^26 squares fit: of
// these below 2^100 each, as of the others. Still larger ones, of 2^44 units, count as that.
constexpr Wide kFine = Wide{1} << 50, kLargest = Wide{1} << 74;
constexpr int kLastBits = 24;

// Rounded up, of a number up to 2^100.
Wide square_root(Wide square) {
  Wide low = -1, high = Wide{1} << 50;  // low^2 < square <= high^2
  while (high - low > 1) {
    const Wide middle = (low + high) / 2;
    (middle * middle < square ? low : high) = middle;
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
  const Wide limited = std::min(billionths, kLargest);
  if (limited <= kFine) {
    squares_ += limited * limited;
  } else {
    const Wide coarse = ceil_divide(limited, Wide{1} << kLastBits);
    coarse_squares_ += coarse * coarse;
  }
  sum_ += below > 0 ? -limited : limited;
  ++count_;
  return -static_cast<double>(below) / static_cast<double>(common_);
}

void ErrorMeter::tell(const std::optional<Decimal>& bound, Verification& found) const {
  found.max_error = make_decimal(largest_, kMaxDecimals);
  found.max_below = make_decimal(deepest_, kMaxDecimals);
  found.rms_error = root_mean_square();
  found.mean_error = mean();
  found.within_bound = !bound || found.max_error <= *bound;
}

Decimal ErrorMeter::mean() const {
  return count_ == 0 ? Decimal{} : make_decimal(round_divide(sum_, count_), kMaxDecimals);
}

Decimal ErrorMeter::root_mean_square() const {
  if (count_ == 0) return {};
  if (coarse_squares_ == 0) {
    return make_decimal(square_root(ceil_divide(squares_, count_)), kMaxDecimals);
  }
  const Wide all = coarse_squares_ + ceil_divide(squares_, Wide{1} << (2 * kLastBits));
  return make_decimal(square_root(ceil_divide(all, count_)) << kLastBits, kMaxDecimals);
}

}  // namespace microtin::terrain
