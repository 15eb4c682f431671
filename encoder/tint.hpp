// Colours of heights.
#ifndef MICROTIN_ENCODER_TINT_HPP
#define MICROTIN_ENCODER_TINT_HPP

#include <algorithm>
#include <array>
#include <cstddef>

#include "encoder/vector.hpp"

namespace microtin {

// From the valley (0) to the summit (1): red, green and blue of sRGB, from 0 to 1.
inline Vector tint(double t) {
  constexpr std::array<Vector, 6> kTints = {Vector{0.47, 0.62, 0.49}, {0.68, 0.76, 0.56},
                                            {0.87, 0.84, 0.65},       {0.80, 0.68, 0.52},
                                            {0.71, 0.60, 0.52},       {0.96, 0.96, 0.96}};
  const double at = std::clamp(t, 0.0, 1.0) * (kTints.size() - 1);
  const size_t below = std::min(static_cast<size_t>(at), kTints.size() - 2);
  return mix(kTints[below], kTints[below + 1], at - static_cast<double>(below));
}

}  // namespace microtin

#endif
