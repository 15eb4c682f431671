// SPDX-License-Identifier: MIT
// Integer logarithm, power and square root for estimates. Identical on every target.
#ifndef MICROTIN_SHARED_FIXED_MATH_HPP
#define MICROTIN_SHARED_FIXED_MATH_HPP

#include <stdint.h>

#include "shared/compiler.hpp"

namespace microtin {

// A base-2 logarithm with 8 fractional bits.
typedef int32_t Log2;
constexpr Log2 kLog2One = 256;

// Position of the highest set bit of v > 0.
MICROTIN_ONE_COPY inline uint32_t highest_bit(uint64_t v) {
#if defined(__GNUC__) && UINTPTR_MAX > 0xFFFFFFFFu
  return 63u ^ static_cast<uint32_t>(__builtin_clzll(v));
#else
  uint32_t bit = 0;
  if (v >> 32) {
    v >>= 32;
    bit = 32;
  }
  uint32_t w = static_cast<uint32_t>(v);
#if defined(__GNUC__) && !defined(__AVR__)
  return bit + (31u ^ static_cast<uint32_t>(__builtin_clz(w)));
#else
  for (uint32_t step = 16; step != 0; step >>= 1) {
    if (w >> step) {
      w >>= step;
      bit += step;
    }
  }
  return bit;
#endif
#endif
}

// log2(v) within 1/256, for v > 0.
inline Log2 log2_of(uint64_t v) {
  const uint32_t bit = highest_bit(v);
  // The 16 bits behind the leading one, m of 2^16: log2(1 + m) is m + m (1 - m) (0.424 - 0.162 m).
  const uint32_t m = static_cast<uint32_t>(v << (63u - bit) >> 47) & 0xFFFFu;
  const uint32_t bend = (m * (65536u - m) >> 16) * (27800u - (10600u * m >> 16)) >> 16;
  return static_cast<Log2>(bit * 256u + ((m + bend + 128u) >> 8));
}

// 2^l within 1/256 of itself, at least 1 and at most 2^30.
inline uint32_t exp2_of(Log2 l) {
  if (l <= 0) return 1;
  const uint32_t bit = static_cast<uint32_t>(l) >> 8, f = static_cast<uint32_t>(l) & 255u;
  if (bit >= 30) return static_cast<uint32_t>(1) << 30;
  // f of 2^8: 2^f is 1 + f - f (1 - f) (0.305 + 0.078 f).
  const uint32_t mantissa = 32768u + 128u * f - (f * (256u - f) * (9980u + 10u * f) >> 16);
  return mantissa << 16 >> (31u - bit);
}

// v * factor / 2^shift, rounded down; the product fits.
MICROTIN_ONE_COPY inline int64_t scaled(int64_t v, int32_t factor, uint32_t shift) {
  return v * factor >> shift;
}

MICROTIN_ONE_COPY inline int32_t kept_within(int64_t v, int32_t most) {
  return v > most ? most : v < -most ? -most : static_cast<int32_t>(v);
}

// A number at least sqrt(v) and at most 2 + sqrt(v) * (1 + 2^-7), for 0 < v < 2^58.
inline uint32_t sqrt_above(uint64_t v) {
  return exp2_of((log2_of(v) + 3) / 2) + 1;
}

}  // namespace microtin

#endif
