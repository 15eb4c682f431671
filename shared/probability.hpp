// SPDX-License-Identifier: MIT
// Adaptive binary probabilities. A coder supplies bit(probability, value) and uniform(count,
// value): the writing coder writes the value it is given, the reading coder ignores it and returns
// the stream's.
#ifndef MICROTIN_SHARED_PROBABILITY_HPP
#define MICROTIN_SHARED_PROBABILITY_HPP

#include "shared/fixed_math.hpp"
#include "shared/pairs.hpp"

namespace microtin {

// Probabilities given to a coder have 15 bits and stay this far from 0 and 1, so every decision
// costs at least -log2(1 - 64 / 32768) = 0.0028 bits and at most 9: decoding is bounded by the
// payload.
constexpr uint32_t kProbabilityOne = 32768;
constexpr int32_t kProbabilityMargin = 64;

// An escape from a number takes this many bits: 2^-10 of the interval.
constexpr uint32_t kEscapeBits = 10;

// The probability of a one: the mean of two running means of what was seen, both with 15 bits. They
// never leave the margins, to which each step goes only part of the way.
struct AdaptiveBit {
  uint16_t fast;  // each bit weighs 1/32
  uint16_t slow;  // each bit weighs 1/256
};

// With 16 bits.
inline int32_t probability_of(const AdaptiveBit& bit) {
  return static_cast<int32_t>(bit.fast) + bit.slow;
}

// `start` < 256: (start + 1/2) / 256.
inline AdaptiveBit adaptive_bit(uint32_t start) {
  const uint16_t probability = static_cast<uint16_t>(start * 128u + 64u);
  return AdaptiveBit{probability, probability};
}

// Where a bit's means go: both never get there.
constexpr int32_t kTowardsOne = static_cast<int32_t>(kProbabilityOne) - kProbabilityMargin;
constexpr int32_t kTowardsZero = kProbabilityMargin;

#if defined(MICROTIN_PAIRS) && defined(__SSE2__)

// Both means at once: ways are within 2^15, and the high half of a product with 2^(16 - n) is a
// way's 2^n-th part, rounded down.
MICROTIN_IN_PLACE inline void learn(AdaptiveBit& bit, bool one) {
  static_assert(sizeof bit == sizeof(int32_t), "both means make a word");
  const int32_t towards = one ? kTowardsOne << 16 | kTowardsOne : kTowardsZero << 16 | kTowardsZero;
  int32_t means;
  __builtin_memcpy(&means, &bit, sizeof means);
  const __m128i was = _mm_cvtsi32_si128(means);
  const __m128i way = _mm_sub_epi16(_mm_cvtsi32_si128(towards), was);
  const __m128i step = _mm_mulhi_epi16(way, _mm_cvtsi32_si128(1 << (16 - 5) | 1 << (32 - 8)));
  means = _mm_cvtsi128_si32(_mm_add_epi16(was, step));
  __builtin_memcpy(&bit, &means, sizeof means);
}

#else

MICROTIN_IN_PLACE inline void learn(AdaptiveBit& bit, bool one) {
  const int32_t towards = one ? kTowardsOne : kTowardsZero;
  bit.fast = static_cast<uint16_t>(bit.fast + ((towards - bit.fast) >> 5));
  bit.slow = static_cast<uint16_t>(bit.slow + ((towards - bit.slow) >> 8));
}

#endif

template <class Coder>
bool code_bit(Coder& coder, AdaptiveBit& bit, bool value) {
  value = coder.bit(static_cast<uint32_t>(probability_of(bit)) >> 1, value);
  learn(bit, value);
  return value;
}

// Codes with a probability between those of two bits, `share` / 256 of the way to the second; the
// nearer one learns.
template <class Coder>
bool code_between(Coder& coder, AdaptiveBit* bits, uint32_t share, bool value) {
  const int32_t from = probability_of(bits[0]), to = probability_of(bits[1]);
  const int32_t between = from + ((to - from) * static_cast<int32_t>(share) >> 8);
  value = coder.bit(static_cast<uint32_t>(between) >> 1, value);
  learn(bits[share >> 7], value);
  return value;
}

// A probability learned as a function of an estimate on a logarithmic scale: entries at equal
// distances, interpolated between the two nearest, of which the nearer one learns.
template <uint32_t kEntries>
struct Curve {
  AdaptiveBit entry[kEntries];
};

// `position` counts entries with 8 fractional bits; beyond the ends the end entries serve.
template <class Coder, uint32_t kEntries>
bool code_on_curve(Coder& coder, Curve<kEntries>& curve, int32_t position, bool value) {
  const uint32_t last = (kEntries - 1) * 256u - 1u;
  uint32_t at = position < 0 ? 0 : static_cast<uint32_t>(position);
  if (at > last) at = last;
  const uint32_t i = at >> 8;
  return code_between(coder, curve.entry + i, at & 255u, value);
}

// A learned correction of an estimated probability: entries at equal distances from 0 to 1.
struct Calibration {
  AdaptiveBit entry[9];
};

// `estimate` has 11 fractional bits and is below 1.
template <class Coder>
bool code_calibrated(Coder& coder, Calibration& calibration, uint32_t estimate, bool value) {
  return code_between(coder, calibration.entry + (estimate >> 8), estimate & 255u, value);
}

}  // namespace microtin

#endif
