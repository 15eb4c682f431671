// SPDX-License-Identifier: MIT
// Integers that a file multiplies and shifts to real numbers.
#ifndef MICROTIN_ENCODER_EXACT_SCALED_INTEGERS_HPP
#define MICROTIN_ENCODER_EXACT_SCALED_INTEGERS_HPP

#include <algorithm>
#include <optional>

#include "encoder/exact/decimal.hpp"
#include "encoder/layers.hpp"

namespace microtin::exact {

// Scale and offset are binary fractions in the file; each stands for the shortest decimal that
// becomes it, 0.01 for instance. So integer * scale + offset is exact, but for decimals beyond the
// ninth, which are rounded.
class ScaledIntegers {
 public:
  // Nothing if a scale is not from 10^-18 to 10^6, or an offset not below 10^18.
  static std::optional<ScaledIntegers> from(double scale, double offset) {
    const std::optional<Decimal> factor = shortest_decimal(scale, kPlaces);
    const std::optional<Decimal> shift = shortest_decimal(offset, kPlaces);
    if (!factor || !shift || factor->mantissa <= 0 || !(*factor <= Decimal{1000000, 0})) {
      return std::nullopt;
    }
    return ScaledIntegers(*factor, *shift);
  }

  // Below 2^32 in magnitude: 63 bits more stand for scale and offset.
  Decimal operator()(int64_t integer) const {
    const Wide exact = integer * scale_ + offset_;
    if (decimals_ <= kMaxDecimals) return make_decimal(exact, decimals_);
    return make_decimal(round_divide(exact, power_of_ten(decimals_ - kMaxDecimals)), kMaxDecimals);
  }

 private:
  static constexpr int kPlaces = 18;

  ScaledIntegers(Decimal scale, Decimal offset)
      : decimals_(std::max(scale.decimals, offset.decimals)),
        scale_(mantissa_at(scale, decimals_)),
        offset_(mantissa_at(offset, decimals_)) {}

  int decimals_;
  Wide scale_, offset_;
};

}  // namespace microtin::exact

#endif
