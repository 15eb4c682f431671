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
