// SPDX-License-Identifier: MIT
// Exact decimal numbers: what people write in files and on command lines.
#ifndef MICROTIN_ENCODER_EXACT_DECIMAL_HPP
#define MICROTIN_ENCODER_EXACT_DECIMAL_HPP

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

}  // namespace microtin::exact

#endif
