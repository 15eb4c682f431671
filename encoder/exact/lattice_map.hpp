// SPDX-License-Identifier: MIT
// The exact way from a source's numbers along one axis to the lattice.
#ifndef MICROTIN_ENCODER_EXACT_LATTICE_MAP_HPP
#define MICROTIN_ENCODER_EXACT_LATTICE_MAP_HPP

#include "encoder/exact/metadata.hpp"
#include "encoder/exact/wide.hpp"
#include "encoder/layers.hpp"

namespace microtin::exact {

// lattice coordinate = (scale * number + shift) / step, step > 0. Magnitudes stay below 2^110: a
// number's below 2^60, scale's, shift's and step's at most what two axes multiply up to.
struct LatticeMap {
  Wide scale;
  Wide shift;
  Wide step;

  Wide numerator(Wide number) const {
#ifdef __clang_analyzer__  // which does not see that no product of an axis' numbers is 0
    if (step <= 0) __builtin_unreachable();
#endif
    return scale * number + shift;
  }

  // The nearest lattice coordinate, halves up.
  Wide nearest(Wide number) const {
    return round_divide(numerator(number), step);
  }
};

// From numbers that `source` places to those that `lattice` places at the same real coordinate.
inline LatticeMap map_between(const Axis& source, const Axis& lattice) {
  const Wide from = static_cast<Wide>(source.denominator),
             to = static_cast<Wide>(lattice.denominator);
  const Wide scale = static_cast<Wide>(source.numerator) * to;
  const Wide shift = source.offset * to - lattice.offset * from;
  const Wide step = static_cast<Wide>(lattice.numerator) * from;
  const Wide divisor = greatest_common_divisor(scale, greatest_common_divisor(shift, step));
  return {scale / divisor, shift / divisor, step / divisor};
}

// True if both place every number at the same real coordinate.
inline bool is_same(const Axis& a, const Axis& b) {
  const LatticeMap map = map_between(a, b);
  return map.shift == 0 && map.scale == map.step;
}

}  // namespace microtin::exact

#endif
