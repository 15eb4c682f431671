// SPDX-License-Identifier: MIT
// Between the lattice and real coordinates: places and heights, exactly, and as text.
#ifndef MICROTIN_ENCODER_EXACT_LATTICE_MAP_HPP
#define MICROTIN_ENCODER_EXACT_LATTICE_MAP_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "encoder/exact/decimal.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/exact/wide.hpp"
#include "encoder/layers.hpp"

namespace microtin::exact {

struct Placement {
  Axis x{0, 1, 1}, y{0, 1, 1}, z{0, 1, 1};
};

// The exact way from a source's numbers along one axis to the lattice.

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

// Places between those of the lattice, as exact fractions.

// The lattice coordinate whole + part / parts, with 0 <= part < parts.
struct RealCoordinate {
  int64_t whole = 0;
  Wide part = 0, parts = 1;
};

// Both parts count `parts`, which is at most kMostParts.
struct RealPlace {
  int64_t x, y;
  Wide x_part, y_part, parts;
};

constexpr Wide kMostParts = Wide{1} << 76;

// With the smallest common denominator or, if that is above kMostParts, with kMostParts: both
// coordinates are then rounded down, by less than 2^-76 of a lattice step.
RealPlace place_of(const RealCoordinate& x, const RealCoordinate& y);

inline RealPlace place_on_lattice(int64_t x, int64_t y) {
  return {x, y, 0, 0, 1};
}

// A number's coordinate on the lattice. A coordinate within half a unit of the 12th decimal of a
// lattice coordinate stands for that: this many decimals are written of one that has more. Nothing
// if it is 2^62 lattice steps away or farther.
std::optional<RealCoordinate> coordinate_of(const LatticeMap& map, Wide number, const Axis& axis);

// The coordinate of `value`, with at most kPlaceDecimals decimals, as above.
std::optional<RealCoordinate> coordinate_of(Decimal value, const Axis& axis);

// The axes by which places have an x: `x` itself and, of degrees, those a turn west and east, since
// -179.5 and 180.5 are names of one place.
std::vector<Axis> names_of_x(const Axis& x, bool is_degrees);

// A binary number's coordinate, within `low` to `high`, which are below 2^33; nothing beyond, or
// if it is not a number. The value is exact to 2^-63 of a unit, and its coordinate to 2^-62 of a
// lattice step. A value within 2^-50 of itself of a lattice coordinate stands for that: it is
// rounded, and lay on the border of a terrain before.
class BinaryAxis {
 public:
  BinaryAxis(const Axis& axis, int64_t low, int64_t high);
  std::optional<RealCoordinate> operator()(double value) const;

 private:
  double real(int64_t coordinate) const {
    return (static_cast<double>(axis_.offset) +
            static_cast<double>(axis_.numerator) * static_cast<double>(coordinate)) /
           static_cast<double>(axis_.denominator);
  }

  Axis axis_;
  int64_t low_, high_;
  double least_, most_;  // values that are looked at
};

// A height of a surface as a fraction, and its conversions: each rounds once.

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

// Real coordinates of lattice numbers as text.

// Decimals that the coordinates of an axis have: all if there are at most 18, else 12.
int decimals_of(const Axis& axis);

// Writes coordinates on one axis: all their decimals if there are at most 18, else 12, rounded.
class CoordinateText {
 public:
  explicit CoordinateText(const Axis& axis);

  // |number| <= 10^18, and the coordinate below 2^64.
  std::string operator()(int64_t number) const;

  // Characters that the texts of numbers from `low` to `high` have at most.
  size_t longest(int64_t low, int64_t high) const;

 private:
  Axis axis_;
  int decimals_;
  int64_t scale_;  // 10^decimals_
};

}  // namespace microtin::exact

#endif
