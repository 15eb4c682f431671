// SPDX-License-Identifier: MIT
// 128-bit integers for exact conversions, with the three ways to round a quotient.
#ifndef MICROTIN_ENCODER_EXACT_WIDE_HPP
#define MICROTIN_ENCODER_EXACT_WIDE_HPP

#include "encoder/layers.hpp"

namespace microtin::exact {

__extension__ typedef __int128 Wide;

// All quotients: divisor > 0.
inline Wide floor_divide(Wide dividend, Wide divisor) {
  const Wide quotient = dividend / divisor;
  return quotient - (quotient * divisor > dividend ? 1 : 0);
}

inline Wide ceil_divide(Wide dividend, Wide divisor) {
  return -floor_divide(-dividend, divisor);
}

// To the nearest integer, halves up.
inline Wide round_divide(Wide dividend, Wide divisor) {
  return floor_divide(2 * dividend + divisor, 2 * divisor);
}

inline Wide magnitude(Wide v) {
  return v < 0 ? -v : v;
}

struct WholeAndRest {
  Wide whole, rest;  // whole + rest / divisor, 0 <= rest < divisor
};

// factor * value / divisor, exactly, where the product may be too wide: factor >= 0, 0 < divisor <
// 2^125, and the quotient fits.
inline WholeAndRest multiply_divide(Wide factor, Wide value, Wide divisor) {
  const Wide units = floor_divide(value, divisor), part = value - units * divisor;
  Wide product = 0;
  if (!__builtin_mul_overflow(factor, part, &product)) {
    const Wide whole = product / divisor;
    return {factor * units + whole, product - whole * divisor};
  }
  WholeAndRest sum{0, 0};
  for (int bit = 126; bit >= 0; --bit) {  // of the factor, from the highest on
    sum = {2 * sum.whole, 2 * sum.rest + ((factor >> bit & 1) != 0 ? part : 0)};
    for (; sum.rest >= divisor; sum.rest -= divisor) ++sum.whole;
  }
  return {factor * units + sum.whole, sum.rest};
}

inline Wide greatest_common_divisor(Wide a, Wide b) {
  while (b != 0) {
    const Wide rest = a % b;
    a = b;
    b = rest;
  }
  return magnitude(a);
}

}  // namespace microtin::exact

#endif
