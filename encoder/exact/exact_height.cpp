// SPDX-License-Identifier: MIT
#include "encoder/exact/exact_height.hpp"

namespace microtin::exact {
namespace {

// Quick for most numbers, which have 64 bits.
double to_double(Wide number) {
  const auto low = static_cast<int64_t>(number);
  return low == number ? static_cast<double>(low) : static_cast<double>(number);
}

}  // namespace

// Times the axis' denominator a height is whole + rest / under, of which rest / under < 1: a
// quotient by an integer is rounded as if there were none of it, but for its half.
Wide rounded_mantissa(const Axis& z, const ExactHeight& height, int decimals) {
  const Wide scale = power_of_ten(decimals), denominator = static_cast<Wide>(z.denominator);
  const Wide numerator = static_cast<Wide>(z.numerator);
  const auto [whole, rest] = multiply_divide(scale * numerator, height.above, height.under);
  const Wide all = scale * (z.offset + numerator * height.base) + whole;
  const Wide half = rest >= height.under - rest ? 1 : 0;  // of twice the rest the whole part
  return floor_divide(2 * all + half + denominator, 2 * denominator);
}

Decimal rounded_height(const Axis& z, const ExactHeight& height, int decimals) {
  return make_decimal(rounded_mantissa(z, height, decimals), decimals);
}

double real_height(const Axis& z, const ExactHeight& height) {
  const double above = to_double(height.above) / to_double(height.under);
  const Wide base = z.offset + static_cast<Wide>(z.numerator) * height.base;
  return (to_double(base) + static_cast<double>(z.numerator) * above) /
         static_cast<double>(z.denominator);
}

int32_t fixed_height(const ExactHeight& height) {
  const auto [whole, rest] = multiply_divide(65536, height.above, height.under);
  const Wide half = rest >= height.under - rest ? 1 : 0;
  return static_cast<int32_t>(Wide{height.base} * 65536 + whole + half);
}

}  // namespace microtin::exact
