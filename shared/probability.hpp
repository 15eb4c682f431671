// Adaptive binary probabilities. A coder supplies bit(probability, value) and uniform(count,
// value): the writing coder writes the value it is given, the reading coder ignores it and returns
// the stream's.
#ifndef MICROTIN_SHARED_PROBABILITY_HPP
#define MICROTIN_SHARED_PROBABILITY_HPP

#include "shared/fixed_math.hpp"

namespace microtin {

// Probabilities given to a coder have 15 bits and stay this far from 0 and 1, so every decision
// costs at least -log2(1 - 64 / 32768) = 0.0028 bits and at most 9: decoding is bounded by the
// payload.
constexpr uint32_t kProbabilityOne = 32768;
constexpr uint32_t kProbabilityMargin = 64;

inline uint32_t clamp_probability(uint32_t probability15) {
  if (probability15 < kProbabilityMargin) return kProbabilityMargin;
  if (probability15 > kProbabilityOne - kProbabilityMargin) {
    return kProbabilityOne - kProbabilityMargin;
  }
  return probability15;
}

// The probability of a one, learned from what was seen: first quickly, then slowly.
struct AdaptiveBit {
  uint16_t probability;  // 16 fractional bits
  uint16_t seen;         // saturates at kSeenMost
};

constexpr uint16_t kSeenMost = 254;  // then each new bit weighs 1/256

inline void reset(AdaptiveBit& bit, uint32_t probability15) {
  bit.probability = bit.seen = static_cast<uint16_t>(clamp_probability(probability15));
}
inline uint32_t prob(const AdaptiveBit& b) { return static_cast<uint32_t>(b.probability) + b.seen; }
inline void learn(AdaptiveBit& bit, bool one) {
  const int32_t target = one ? 32767 - 64 : 64;
  bit.probability = static_cast<uint16_t>(bit.probability + ((target - bit.probability) >> 5));
  bit.seen = static_cast<uint16_t>(bit.seen + ((target - bit.seen) >> 7));
}

template <class Coder>
bool code_bit(Coder& coder, AdaptiveBit& bit, bool value) {
  value = coder.bit(prob(bit) / 2u, value);
  learn(bit, value);
  return value;
}

// The probability, in 15 bits, whose odds are 2^odds.
inline uint32_t probability_of_odds(Log2 odds) {
  const uint64_t ratio = exp2_of((odds < 0 ? -odds : odds) + 8 * kLog2One);  // 8 fractional bits
  const uint32_t small =
      static_cast<uint32_t>((static_cast<uint64_t>(kProbabilityOne) << 8) / (ratio + 256u));
  return odds < 0 ? small : kProbabilityOne - small;
}

// A probability learned as a function of an estimate on a logarithmic scale: entries at equal
// distances, interpolated between the two nearest, of which the nearer one learns.
template <uint32_t kEntries>
struct Curve {
  AdaptiveBit entry[kEntries];
};

// Starts the entries at odds 2^first, 2^(first + step), ...
template <uint32_t kEntries>
void reset(Curve<kEntries>& curve, Log2 first, Log2 step) {
  for (uint32_t i = 0; i < kEntries; ++i, first += step) {
    reset(curve.entry[i], probability_of_odds(first));
  }
}

// `position` counts entries with 8 fractional bits; beyond the ends the end entries serve.
template <class Coder, uint32_t kEntries>
bool code_on_curve(Coder& coder, Curve<kEntries>& curve, int32_t position, bool value) {
  const uint32_t last = (kEntries - 1) * 256u;
  uint32_t at = position < 0 ? 0 : static_cast<uint32_t>(position);
  if (at > last) at = last;
  const uint32_t i = at == last ? kEntries - 2 : at >> 8;
  const uint32_t f = at - i * 256u;
  AdaptiveBit& low = curve.entry[i];
  AdaptiveBit& high = curve.entry[i + 1];
  const int32_t from = static_cast<int32_t>(prob(low)), to = static_cast<int32_t>(prob(high));
  const int32_t blend = from + ((to - from) * static_cast<int32_t>(f) >> 8);
  value = coder.bit(static_cast<uint32_t>(blend) >> 1, value);
  learn(f < 128 ? low : high, value);
  return value;
}

// A learned correction of an estimated probability: entries at equal distances from 0 to 1,
// interpolated between the two nearest, of which the nearer one learns.
template <uint32_t kEntries>
struct Calibration {
  AdaptiveBit entry[kEntries];
};

template <uint32_t kEntries>
void reset(Calibration<kEntries>& calibration) {
  for (uint32_t i = 0; i < kEntries; ++i) {
    reset(calibration.entry[i], clamp_probability(i * (kProbabilityOne / (kEntries - 1))));
  }
}

// `estimate` has 15 fractional bits and is below 1.
template <class Coder, uint32_t kEntries>
bool code_calibrated(Coder& coder, Calibration<kEntries>& calibration, uint32_t estimate,
                     bool value) {
  const uint32_t position = estimate * (kEntries - 1);
  const uint32_t i = position >> 15, f = position >> 7 & 255u;
  AdaptiveBit& low = calibration.entry[i];
  AdaptiveBit& high = calibration.entry[i + 1];
  const int32_t from = static_cast<int32_t>(prob(low)), to = static_cast<int32_t>(prob(high));
  const int32_t blend = from + ((to - from) * static_cast<int32_t>(f) >> 8);
  value = coder.bit(static_cast<uint32_t>(blend) >> 1, value);
  learn(f < 128 ? low : high, value);
  return value;
}

}  // namespace microtin

#endif
