// SPDX-License-Identifier: MIT
// Places between those of the lattice, as exact fractions.
#ifndef MICROTIN_ENCODER_EXACT_REAL_PLACE_HPP
#define MICROTIN_ENCODER_EXACT_REAL_PLACE_HPP

#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/exact/decimal.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/exact/metadata.hpp"
#include "encoder/exact/wide.hpp"
#include "encoder/layers.hpp"

namespace microtin::exact {

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
// lattice coordinate stands for that: so many decimals are written of one that has more. Nothing
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

}  // namespace microtin::exact

#endif
