// SPDX-License-Identifier: MIT
// Real coordinates of lattice numbers as text.
#ifndef MICROTIN_ENCODER_EXACT_COORDINATES_HPP
#define MICROTIN_ENCODER_EXACT_COORDINATES_HPP

#include <cstddef>
#include <cstdint>
#include <string>

#include "encoder/exact/metadata.hpp"
#include "encoder/layers.hpp"

namespace microtin::exact {

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
