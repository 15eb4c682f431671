// SPDX-License-Identifier: MIT
// Where a segment crosses an edge of a terrain, and the numbers that follow from it.
#ifndef MICROTIN_DECODER_CROSSING_HPP
#define MICROTIN_DECODER_CROSSING_HPP

#include "decoder/local_point.hpp"
#include "microtin/microtin.h"
#include "shared/fixed_math.hpp"

namespace microtin {

// A part of the segment's length, from where it begins: 0 <= part <= whole < 2^50.
struct Along {
  int64_t part, whole;
};

// A place of the segment: its begin, its end, a vertex on it, or where it crosses an edge.
//
// On an edge the height is linear: `height` where `share` is 0, `other` where `share` is
// along.whole, both multiples of 65536. `share` is 0 at a vertex, and negative where the height is
// that of a triangle's plane, rounded.
struct Crossing {
  Along along;
  int64_t share;
  int32_t height, other;  // 16 fractional bits
  uint8_t result;         // a microtin_query_result: OK, or why there is no height
  uint8_t before;         // OK: there are heights from the crossing before to this one; or why not
};

// Negative if a is less than b, positive if it is greater: binary digits side by side. Fractions
// that differ do so by more than 2^-100.
inline int compare(const Along& a, const Along& b) {
  int64_t rest_a = a.part, rest_b = b.part;
  for (int i = 0; i <= 100; ++i) {
    const bool one_a = rest_a >= a.whole, one_b = rest_b >= b.whole;
    if (one_a != one_b) return one_a ? 1 : -1;
    rest_a = (one_a ? rest_a - a.whole : rest_a) * 2;
    rest_b = (one_b ? rest_b - b.whole : rest_b) * 2;
  }
  return 0;
}

// A quotient with 17 fractional bits, rounded down, and whether there is a rest.
struct LongQuotient {
  uint64_t value;
  bool has_rest;
};

// size * part / whole; part <= whole < 2^50, 0 < size < 2^16. Long division, a bit of `size` and
// then a fractional bit at a time: the rest stays below 3 * whole.
MICROTIN_ONE_COPY inline LongQuotient long_share(uint32_t size, uint64_t part, uint64_t whole) {
  uint64_t quotient = 0, rest = 0;
  for (int bit = 15; bit >= -17; --bit) {
    quotient *= 2;
    rest *= 2;
    if (bit >= 0 && (size >> bit & 1u) != 0) rest += part;
    for (int i = 0; i < 2 && rest >= whole; ++i) {
      rest -= whole;
      ++quotient;
    }
  }
  return LongQuotient{quotient, rest != 0};
}

// Digits of part / whole, where whole < 2^31, by 32-bit divisions.
class ShortDivision {
 public:
  // part <= whole.
  ShortDivision(uint32_t part, uint32_t whole)
      : number_(static_cast<uint64_t>(part) << (30 - highest_bit(whole))),
        whole_(whole << (30 - highest_bit(whole))) {}

  // The quotient of what is left, times a factor up to 2^16, rounded down. What is left becomes
  // less than the whole. The whole is 2^30 .. 2^31, so that the first guess is too small by 3 at
  // most.
  MICROTIN_ONE_COPY uint32_t digit(uint32_t factor) {
    number_ *= factor;  // below 2^47
    uint32_t digit = static_cast<uint32_t>(number_ >> 15) / ((whole_ >> 15) + 1);
    number_ -= static_cast<uint64_t>(digit) * whole_;
    for (; number_ >= whole_; ++digit) number_ -= whole_;
    return digit;
  }
  bool has_rest() const { return number_ != 0; }

 private:
  uint64_t number_;
  uint32_t whole_;
};

// Equals long_share where whole < 2^31.
inline LongQuotient short_share(uint32_t size, uint32_t part, uint32_t whole) {
  ShortDivision division(part, whole);
  uint64_t quotient = division.digit(size);
  quotient = quotient << 15 | division.digit(UINT32_C(1) << 15);
  quotient = quotient << 2 | division.digit(4);
  return LongQuotient{quotient, division.has_rest()};
}

// rise * part / whole with 16 fractional bits, rounded to nearest, halves up; 0 <= part <= whole <
// 2^50, |rise| < 2^16.
inline int64_t share(int32_t rise, int64_t part, int64_t whole) {
  const uint32_t size = static_cast<uint32_t>(rise < 0 ? -rise : rise);
  const LongQuotient found =
      whole >> 31 == 0
          ? short_share(size, static_cast<uint32_t>(part), static_cast<uint32_t>(whole))
          : long_share(size, static_cast<uint64_t>(part), static_cast<uint64_t>(whole));
  return rise >= 0 ? static_cast<int64_t>((found.value + 1) >> 1)
                   : -static_cast<int64_t>((found.value + (found.has_rest ? 1 : 0)) >> 1);
}

// The height at a crossing, rounded once. The share of the rise may not fit in 32 bits; the sum
// lies between the ends.
inline int32_t height_of(const Crossing& c) {
  if (c.share <= 0) return c.height;
  const int32_t rise = (c.other >> 16) - (c.height >> 16);
  return static_cast<int32_t>(c.height + share(rise, c.share, c.along.whole));
}

// The part of the length with 30 fractional bits, rounded down. The rest stays below 2 * whole.
MICROTIN_ONE_COPY inline int32_t rounded_down(const Along& along) {
  if (along.part >= along.whole) return INT32_C(1) << 30;
  if (along.part <= 0) return 0;
  if (along.whole >> 31 == 0) {
    ShortDivision division(static_cast<uint32_t>(along.part), static_cast<uint32_t>(along.whole));
    const uint32_t high = division.digit(UINT32_C(1) << 15);
    return static_cast<int32_t>(high << 15 | division.digit(UINT32_C(1) << 15));
  }
  const uint64_t whole = static_cast<uint64_t>(along.whole);
  uint64_t rest = static_cast<uint64_t>(along.part);
  int32_t quotient = 0;
  for (int bit = 0; bit < 30; ++bit) {
    quotient *= 2;
    rest *= 2;
    if (rest < whole) continue;
    rest -= whole;
    ++quotient;
  }
  return quotient;
}

}  // namespace microtin

#endif
