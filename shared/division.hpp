// SPDX-License-Identifier: MIT
// 64-bit division. Where the machine has none it is done bit by bit: the compilers' helpers, but
// for those of AVR, are several times the code.
#ifndef MICROTIN_SHARED_DIVISION_HPP
#define MICROTIN_SHARED_DIVISION_HPP

#include <stdint.h>

#include "shared/fixed_math.hpp"

namespace microtin {

struct Quotient {
  uint64_t whole;
  uint64_t rest;
};

#if UINTPTR_MAX > 0xFFFFFFFFu || defined(__wasm__) || defined(__AVR__)

// d > 0.
inline Quotient divide(uint64_t n, uint64_t d) {
  return Quotient{n / d, n % d};
}

// floor(n * 2^17 / d), below 2^35; 0 < d <= 2^40.
inline uint64_t divide_finely(uint64_t n, uint64_t d) {
  return (n / d << 17) + (n % d << 17) / d;
}

#else

MICROTIN_OUT_OF_LINE inline Quotient divide(uint64_t n, uint64_t d) {
  uint64_t bit = 1, whole = 0;
  for (; d <= n >> 1; d <<= 1) bit <<= 1;
  for (; bit != 0; bit >>= 1, d >>= 1) {
    if (n < d) continue;
    n -= d;
    whole |= bit;
  }
  return Quotient{whole, n};
}

inline uint64_t divide_finely(uint64_t n, uint64_t d) {
  uint64_t whole = 0;
  d <<= 17;
  for (int i = 0; i < 35; ++i) {
    whole <<= 1;
    if (n >= d) {
      n -= d;
      ++whole;
    }
    n <<= 1;  // < 2 * d <= 2^58
  }
  return whole;
}

#endif

// n / d, rounded down; d > 0.
inline int64_t floor_of(int64_t n, int64_t d) {
  const int64_t whole = static_cast<int64_t>(
      divide(static_cast<uint64_t>(n < 0 ? ~n : n), static_cast<uint64_t>(d)).whole);
  return n < 0 ? ~whole : whole;
}

}  // namespace microtin

#endif
