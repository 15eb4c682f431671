// SPDX-License-Identifier: MIT
// A height of a surface as a fraction, and its conversions: each rounds once.
#ifndef MICROTIN_ENCODER_EXACT_EXACT_HEIGHT_HPP
#define MICROTIN_ENCODER_EXACT_EXACT_HEIGHT_HPP

#include <cstdint>

#include "encoder/exact/decimal.hpp"
#include "encoder/exact/metadata.hpp"
#include "encoder/exact/wide.hpp"
#include "encoder/layers.hpp"

namespace microtin::exact {

// base + above / under z steps; under > 0, |above| <= 2^16 * under < 2^125.
struct ExactHeight {
  int32_t base;
  Wide above, under;
};

// A height query's answer, which has 16 fractional bits.
inline ExactHeight height_of_answer(int32_t answer) {
  return {0, answer, 65536};
}

// The height in real units, rounded to `decimals` (at most kMaxDecimals), halves up.
Decimal rounded_height(const Axis& z, const ExactHeight& height, int decimals);

// The height in real units as a whole number of units in the last of `decimals`, halves rounded up.
Wide rounded_mantissa(const Axis& z, const ExactHeight& height, int decimals);

// In real units: off by at most three units in the last place of the result or, if that is larger,
// of the difference between `base` and the height.
double real_height(const Axis& z, const ExactHeight& height);

// In z steps, to 16 fractional bits, as height queries answer.
int32_t fixed_height(const ExactHeight& height);

}  // namespace microtin::exact

#endif
