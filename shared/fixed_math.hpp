// SPDX-License-Identifier: MIT
// Comparisons, integer logarithms, power and roots for estimates, and 64-bit division. Identical on
// every target.
#ifndef MICROTIN_SHARED_FIXED_MATH_HPP
#define MICROTIN_SHARED_FIXED_MATH_HPP

#include <stdint.h>

#include "shared/compiler.hpp"

namespace microtin {

// A base-2 logarithm with 8 fractional bits.
typedef int32_t Log2;
constexpr Log2 kLog2One = 256;

// Position of the highest set bit of v > 0.
#if __SIZEOF_INT__ == 4  // what the builtin takes
MICROTIN_IN_PLACE inline uint32_t highest_bit(uint32_t v) {
  return 31u ^ static_cast<uint32_t>(__builtin_clz(v));
}
#else
MICROTIN_ONE_COPY inline uint32_t highest_bit(uint32_t v) {
  uint32_t bit = 0;
  for (uint32_t step = 16; step != 0; step >>= 1) {
    if (v >> step) {
      v >>= step;
      bit += step;
    }
  }
  return bit;
}
#endif

// log2(v) within 1/256, for v > 0.
inline Log2 log2_of(uint32_t v) {
  const uint32_t bit = highest_bit(v);
  // The 16 bits behind the leading one, m of 2^16: log2(1 + m) is m + m (1 - m) (0.424 - 0.162 m).
  const uint32_t m = v << (31u - bit) >> 15 & 0xFFFFu;
  const uint32_t bend = (m * (65536u - m) >> 16) * (27800u - (10600u * m >> 16)) >> 16;
  return static_cast<Log2>(bit * 256u + ((m + bend + 128u) >> 8));
}

// A rough one: straight between powers of two, 0.086 too low at most.
inline Log2 rough_log2(uint32_t v) {
  const uint32_t bit = highest_bit(v);
  return static_cast<Log2>((bit << 8) + (v << (31u - bit) >> 23 & 0xFFu));
}

// The inverse of it, 0 for l < 0; l < 2^13.
inline uint32_t rough_exp2(Log2 l) {
  if (l < 0) return 0;
  const uint32_t bit = static_cast<uint32_t>(l) >> 8;
  return (256u + (static_cast<uint32_t>(l) & 255u)) << 23 >> (31u - bit);
}

template <class Number>
constexpr Number smaller(Number a, Number b) {
  return a < b ? a : b;
}

template <class Number>
constexpr Number larger(Number a, Number b) {
  return a < b ? b : a;
}

inline int32_t kept_within(int32_t v, int32_t least, int32_t most) {
  return v < least ? least : v > most ? most : v;
}

// The root of v, rounded down, or up to 2^-11 of it and 1 more, for 0 < v < 2^31.
MICROTIN_ONE_COPY inline uint32_t rough_root(uint32_t v) {
  const uint32_t half = highest_bit(v) >> 1;
  const uint32_t guess = (11u * (v >> half) + ((static_cast<uint32_t>(22) << half) + 32u)) >> 5;
  return (guess + v / guess) >> 1;
}

// Where the machine has no 64-bit division it is done bit by bit: the compilers' helpers, but for
// those of AVR, are several times the code.
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
