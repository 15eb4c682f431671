// SPDX-License-Identifier: MIT
// From real coordinates to steps of an axis.
#ifndef MICROTIN_DECODER_AXIS_HPP
#define MICROTIN_DECODER_AXIS_HPP

#include <stdint.h>

#include "microtin/microtin.h"

namespace microtin {

// Steps with 9 fractional bits, rounded down, at which the axis has value / per_unit units: one bit
// more than is asked for, which says how to round. -1 is less than half a 1/256 step outside; below
// that, the place is outside 0 .. `most` steps, per_unit outside 1 .. 2^24, or the axis' offset
// outside +-2^61. Needs (most + 1) * axis.numerator < 2^61. Six 64-bit divisions.
int64_t half_steps(const microtin_axis& axis, uint32_t most, int64_t value, uint32_t per_unit);

// To nearest with 8 fractional bits, halves up.
inline int64_t rounded_steps(int64_t half_steps) {
  return (half_steps + 1) >> 1;
}

}  // namespace microtin

#endif
