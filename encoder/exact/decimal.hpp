// SPDX-License-Identifier: MIT
// Exact decimal numbers: what people write in files and on command lines, and what files scale.
#ifndef MICROTIN_ENCODER_EXACT_DECIMAL_HPP
#define MICROTIN_ENCODER_EXACT_DECIMAL_HPP

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "encoder/exact/wide.hpp"
#include "encoder/layers.hpp"

namespace microtin::exact {

// Decimals kept of a terrain's numbers and of options; more are rounded.
constexpr int kMaxDecimals = 9;

// mantissa * 10^-decimals, decimals in 0..18, no trailing zero among the decimals.
struct Decimal {
  int64_t mantissa = 0;
  int decimals = 0;
};

bool operator==(Decimal a, Decimal b);
bool operator<=(Decimal a, Decimal b);

// 10^exponent, exponent in 0..18.
int64_t power_of_ten(int exponent);

// mantissa * 10^-decimals without trailing zeros; decimals that do not fit are cut off, and what
// then is still too large is the largest possible.
Decimal make_decimal(Wide mantissa, int decimals);

// As make_decimal, but decimals that do not fit are rounded: up, of a magnitude, or to nearest.
Decimal make_decimal_up(Wide mantissa, int decimals);
Decimal make_decimal_nearest(Wide mantissa, int decimals);

// A half, whose last decimal is cut off if there are too many.
Decimal half(Decimal value);

// The mantissa that `value` has with `decimals` >= value.decimals decimals.
Wide mantissa_at(Decimal value, int decimals);

// Reads "12", "-0.25", "+7.30e-1", ".5", "5."; nothing else may precede or follow. Decimals beyond
// `max_decimals`, or beyond 18 digits in all, are rounded to nearest (ties away from zero). Nothing
// if the text is not a finite number or its magnitude is not below 10^18.
std::optional<Decimal> parse_decimal(std::string_view text, int max_decimals = kMaxDecimals);

// The shortest decimal that is read as this binary number, rounded as above. Nothing if it is not
// finite or too large.
std::optional<Decimal> shortest_decimal(float value, int max_decimals = kMaxDecimals);
std::optional<Decimal> shortest_decimal(double value, int max_decimals = kMaxDecimals);

// "-0.25": shortest form that reads back equal.
std::string to_string(Decimal value);

// The nearest binary number.
double real(Decimal value);

// Integers that a file multiplies and shifts to real numbers.

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
