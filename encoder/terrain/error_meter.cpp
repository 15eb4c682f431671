// SPDX-License-Identifier: MIT
// Errors in billionths, in wide integers.
#include "encoder/terrain/error_meter.hpp"

#include <algorithm>

namespace microtin::terrain {
namespace {

constexpr int64_t kBillion = 1000000000;

// Larger errors (a million units, in billionths) count as this in the mean, so that 2^26 squares
// fit.
constexpr Wide kLargestSquared = Wide{1} << 50;

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
  const Wide limited = std::min(billionths, kLargestSquared);
  squares_ += limited * limited;
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
  const Wide mean = ceil_divide(squares_, count_);
  Wide low = -1, high = kLargestSquared;  // low^2 < mean <= high^2
  while (high - low > 1) {
    const Wide middle = (low + high) / 2;
    (middle * middle < mean ? low : high) = middle;
  }
  return make_decimal(high, kMaxDecimals);
}

}  // namespace microtin::terrain
