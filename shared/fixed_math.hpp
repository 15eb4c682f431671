// Integer logarithm, power and square root for estimates. Identical on every target.
#ifndef MICROTIN_SHARED_FIXED_MATH_HPP
#define MICROTIN_SHARED_FIXED_MATH_HPP

#include <stdint.h>

#include "shared/tables.hpp"

// Keeps rare code, and code that is vectorised only if no loop is around it, out of its callers.
#if defined(__GNUC__)
#define MICROTIN_OUT_OF_LINE __attribute__((noinline))
#else
#define MICROTIN_OUT_OF_LINE
#endif

namespace microtin {

// A base-2 logarithm with 8 fractional bits.
typedef int32_t Log2;
constexpr Log2 kLog2One = 256;

// Position of the highest set bit of v > 0.
inline uint32_t highest_bit(uint64_t v) {
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

// log2(v) within 1/256, for v > 0; log2_of(0) is that of 1.
inline Log2 log2_of(uint64_t v) {
  if (v == 0) return 0;
  const uint32_t bit = highest_bit(v);
  // The 13 bits behind the leading one: 5 choose the table entry, 8 interpolate.
  const uint32_t mantissa =
      static_cast<uint32_t>(bit >= 13 ? v >> (bit - 13) : v << (13 - bit)) & 0x1FFFu;
  const uint32_t i = mantissa >> 8;
  const int32_t low = table_log2(i), high = table_log2(i + 1);
  const int32_t fraction = low + (((high - low) * static_cast<int32_t>(mantissa & 255)) >> 8);
  return static_cast<Log2>(bit) * kLog2One + ((fraction + 8) >> 4);
}

// 2^l within 1/256 of itself, saturated to 1 .. 2^62.
inline uint64_t exp2_of(Log2 l) {
  if (l <= 0) return 1;
  const uint32_t bit = static_cast<uint32_t>(l) >> 8;
  if (bit >= 62) return static_cast<uint64_t>(1) << 62;
  const uint32_t i = (static_cast<uint32_t>(l) & 255u) >> 3;
  const uint32_t f = static_cast<uint32_t>(l) & 7u;
  const uint32_t low = table_exp2(i), high = table_exp2(i + 1);
  const uint64_t mantissa = 32768u + low + (((high - low) * f) >> 3);  // 15 fractional bits
  return bit >= 15 ? mantissa << (bit - 15) : mantissa >> (15 - bit);
}

// A number at least sqrt(v) and at most 3 + sqrt(v) * (1 + 2^-13), for v < 2^62.
inline uint32_t sqrt_above(uint64_t v) {
  uint32_t shift = 0;
  while (v >> 32 >> 2 * shift) ++shift;  // at most 15 times
  const uint32_t w = static_cast<uint32_t>(v >> 2 * shift);
  // One Newton step from any start ends at or above the root: (r + w / r) / 2 >= sqrt(w).
  const uint32_t r = static_cast<uint32_t>(exp2_of(log2_of(w) / 2)) + 1;
  return ((r + w / r) / 2 + 2) << shift;
}

}  // namespace microtin

#endif
