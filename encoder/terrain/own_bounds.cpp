// SPDX-License-Identifier: MIT
// Scales the bounds of posts, and compares errors with them.
#include "encoder/terrain/own_bounds.hpp"

#include <algorithm>

namespace microtin::terrain {

void BoundSpan::add(const BoundSpan& other) {
  if (other.bounded != 0) {
    if (bounded == 0 || other.least <= least) least = other.least;
    if (bounded == 0 || largest <= other.largest) largest = other.largest;
    if (ratio <= other.ratio) ratio = other.ratio;
  }
  bounded += other.bounded;
  unbounded += other.unbounded;
}

BoundOf::BoundOf(const OwnBounds& own, const std::optional<Decimal>& max_error, int decimals)
    : own_(own), all_(max_error ? mantissa_at(*max_error, decimals) : kNone) {
  if (own.empty() || !max_error) return;
  factor_ = power_of_ten(decimals);
  divisor_ = power_of_ten(own.decimals);
  const Decimal whole = *own.unscaled;
  if (*max_error == whole || whole.mantissa == 0) return;
  // Magnitudes stay below 10^36: decimals are at most 9, mantissas below 10^18.
  factor_ *= Wide{max_error->mantissa} * power_of_ten(whole.decimals);
  divisor_ *= Wide{whole.mantissa} * power_of_ten(max_error->decimals);
  const Wide divisor = greatest_common_divisor(factor_, divisor_);
  if (divisor == 0) return;
  factor_ /= divisor;
  divisor_ /= divisor;
}

Wide BoundOf::own_bound(int64_t number) const {
  return number == kUnbounded ? kNone : multiply_divide(factor_, number, divisor_).whole;
}

Decimal least_bound(const OwnBounds& own, Decimal max_error) {
  const BoundOf bound_of(own, max_error, kMaxDecimals);
  Wide least = 0;
  for (std::size_t i = 0; i < own.numbers.size(); ++i) {
    const Wide bound = bound_of(i);
    if (bound > 0 && (least == 0 || bound < least)) least = bound;
  }
  constexpr Wide kFinest = 1000;  // a step of few digits leaves room for parts of it
  if (least > kFinest) least -= least % kFinest;
  return least == 0 ? max_error : make_decimal(least, kMaxDecimals);
}

void BoundMeter::add(Wide error, Wide bound) {
  if (bound == BoundOf::kNone) {
    ++unbounded_;
    return;
  }
  least_ = bounded_ == 0 ? bound : std::min(least_, bound);
  largest_ = std::max(largest_, bound);
  ++bounded_;
  keeps_all_ = keeps_all_ && error <= bound;
  if (bound == 0) return;
  const auto [whole, rest] = multiply_divide(power_of_ten(kMaxDecimals), error, bound);
  ratio_ = std::max(ratio_, whole + (rest != 0 ? 1 : 0));
}

BoundSpan BoundMeter::span() const {
  return {bounded_, unbounded_, make_decimal(least_, kMaxDecimals),
          make_decimal(largest_, kMaxDecimals), make_decimal_up(ratio_, kMaxDecimals)};
}

}  // namespace microtin::terrain
