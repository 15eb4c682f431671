// SPDX-License-Identifier: MIT
// From the lattice to real units.
#include "decoder/axis.hpp"
#include "shared/fixed_math.hpp"

namespace microtin {
namespace {

constexpr int64_t kMostUnits = static_cast<int64_t>(1) << 38;

// rest / d * factor, rounded to nearest, halves up; rest < d < 2^57, factor < 2^25. Bit by bit: the
// product has more than 64.
int64_t scaled(uint64_t rest, uint64_t d, uint32_t factor) {
  uint64_t left = 0;
  int64_t whole = 0;
  for (uint32_t bit = kMostPerUnit; bit != 0; bit >>= 1) {
    whole *= 2;
    left *= 2;  // < 2 d
    if ((factor & bit) != 0) left += rest;
    for (; left >= d; left -= d) ++whole;  // twice at most: left < 3 d
  }
  return whole + (left * 2 >= d ? 1 : 0);
}

// (offset + numerator * place) / denominator * per_unit; the place has this many fractional bits,
// at most 16.
bool real_value(const microtin_axis& axis, int64_t place, int bits, uint32_t per_unit,
                int64_t* value) {
  if (!is_convertible(axis, per_unit)) return false;
  const int64_t steps = place >> bits;  // rounded down
  const uint64_t size = static_cast<uint64_t>(steps < 0 ? -steps : steps);
  if (size > divide(static_cast<uint64_t>(1) << 62, axis.numerator).whole) return false;
  const int64_t numerator = static_cast<int64_t>(axis.numerator);
  const int64_t denominator = static_cast<int64_t>(axis.denominator);
  const int64_t parts = axis.offset + numerator * steps;  // within 2^61 + 2^62
  const int64_t units = floor_of(parts, denominator);
  const uint64_t rest = static_cast<uint64_t>(parts - units * denominator);
  // Below 2^40 * 2^16 each.
  const uint64_t fraction = static_cast<uint64_t>(place) & ((static_cast<uint64_t>(1) << bits) - 1);
  const uint64_t fine = (rest << bits) + axis.numerator * fraction, d = axis.denominator << bits;
  const Quotient more = divide(fine, d);
  const int64_t whole = units + static_cast<int64_t>(more.whole);  // and 2^40 more
  if (whole >= kMostUnits || whole < -kMostUnits) return false;
  *value = whole * static_cast<int64_t>(per_unit) + scaled(more.rest, d, per_unit);
  return true;
}

}  // namespace
}  // namespace microtin

using namespace microtin;

microtin_status microtin_axis_from_lattice(const microtin_axis* axis, int64_t lattice,
                                           uint32_t per_unit, int64_t* value) {
  return real_value(*axis, lattice, 8, per_unit, value) ? MICROTIN_STATUS_OK
                                                        : MICROTIN_STATUS_OUT_OF_RANGE;
}

microtin_status microtin_axis_height(const microtin_axis* z, int32_t height, uint32_t per_unit,
                                     int32_t* value) {
  int64_t found = 0;
  if (!real_value(*z, height, 16, per_unit, &found) || found != static_cast<int32_t>(found)) {
    return MICROTIN_STATUS_OUT_OF_RANGE;
  }
  *value = static_cast<int32_t>(found);
  return MICROTIN_STATUS_OK;
}
