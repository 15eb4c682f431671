// SPDX-License-Identifier: MIT
// Real coordinates of lattice numbers as text.
#ifndef MICROTIN_ENCODER_EXACT_COORDINATES_HPP
#define MICROTIN_ENCODER_EXACT_COORDINATES_HPP

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

 private:
  Axis axis_;
  int decimals_;
  int64_t scale_;  // 10^decimals_
};

}  // namespace microtin::exact

#endif
