// SPDX-License-Identifier: MIT
// From real coordinates to steps of an axis.
#ifndef MICROTIN_DECODER_AXIS_HPP
#define MICROTIN_DECODER_AXIS_HPP

#include <stdint.h>

#include "microtin/microtin.h"

namespace microtin {

constexpr uint32_t kMostPerUnit = 1ul << 24;
constexpr int64_t kMostOffset = static_cast<int64_t>(1) << 61;

// Whether an axis' positions fit parts of a unit without overflow.
inline bool is_convertible(const microtin_axis& axis, uint32_t per_unit) {
  return per_unit != 0 && per_unit <= kMostPerUnit && axis.offset < kMostOffset &&
         axis.offset > -kMostOffset;
}

// Steps with 9 fractional bits, rounded down, at which the axis has value / per_unit units: one bit
// more than is asked for, which says how to round. -1 is less than half a 1/256 step outside; below
// that, the place is outside 0 .. `most` steps, or the axis not convertible. Needs (most + 1) *
// axis.numerator < 2^61. Six 64-bit divisions.
int64_t half_steps(const microtin_axis& axis, uint32_t most, int64_t value, uint32_t per_unit);

// To nearest with 8 fractional bits, halves up.
inline int64_t rounded_steps(int64_t half_steps) {
  return (half_steps + 1) >> 1;
}

}  // namespace microtin

#endif
