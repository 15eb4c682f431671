// SPDX-License-Identifier: MIT
// Divides real coordinates by the steps of an axis, in integers.
#include "decoder/axis.hpp"

#include "shared/fixed_math.hpp"

namespace microtin {

// A place is (value / per_unit * denominator - offset) / numerator steps.
int64_t half_steps(const microtin_axis& axis, uint32_t most, int64_t value, uint32_t per_unit) {
  const int64_t outside = -2;
  if (!is_convertible(axis, per_unit)) return outside;
  const uint64_t denominator = axis.denominator, numerator = axis.numerator;  // < 2^40
  // Split into whole units, the most that are not above, and rest. One Quotient for all divisions
  // saves stack.
  const int64_t sign = value < 0 ? -1 : 0;
  Quotient part = divide(static_cast<uint64_t>(value ^ sign), per_unit);
  // Inside, whole * denominator <= offset + (most + 1/512) * numerator < 2^62, and it is above
  // -2^61 - 2^41: what is farther from 0 is refused before it can overflow.
  if (part.whole > divide(static_cast<uint64_t>(1) << 62, denominator).whole) return outside;
  const int64_t whole = static_cast<int64_t>(part.whole) ^ sign;
  const uint64_t rest = sign != 0 ? per_unit - 1u - part.rest : part.rest;
  const int64_t product = whole * static_cast<int64_t>(denominator);  // within 2^62 + 2^40
  part = divide(rest * denominator, per_unit);                        // < 2^64; < 2^40
  // In numerator-ths of a step, from a step before 0: within 2^62 + 2^61 + 2^41; and a rest of one.
  const uint64_t part_rest = part.rest * 512u;  // / per_unit / 512
  const int64_t ahead = static_cast<int64_t>(part.whole + numerator) - axis.offset + product;
  if (ahead < 0) return outside;
  part = divide(static_cast<uint64_t>(ahead), numerator);
  if (part.whole > static_cast<uint64_t>(most) + 1) return outside;
  const uint64_t fine = part.rest * 512u + divide(part_rest, per_unit).whole;  // < 2^49
  const int64_t found =
      static_cast<int64_t>(part.whole * 512u + divide(fine, numerator).whole) - 512;
  return found > static_cast<int64_t>(most) * 512 ? outside : found;
}

}  // namespace microtin
