// SPDX-License-Identifier: MIT
// Colours, and those of heights.
#ifndef MICROTIN_ENCODER_EXPORT_COLOUR_HPP
#define MICROTIN_ENCODER_EXPORT_COLOUR_HPP

#include <algorithm>
#include <array>
#include <cstddef>

#include "encoder/layers.hpp"

namespace microtin::exporting {

// A colour of sRGB.
struct Colour {
  double r, g, b;  // 0 .. 1
};

inline Colour mix(Colour a, Colour b, double t) {
  return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}

// From the valley, at 0, to the summit, at 1.
inline Colour tint(double relative) {
  constexpr std::array<Colour, 6> kTints = {{{0.47, 0.62, 0.49},
                                             {0.68, 0.76, 0.56},
                                             {0.87, 0.84, 0.65},
                                             {0.80, 0.68, 0.52},
                                             {0.71, 0.60, 0.52},
                                             {0.96, 0.96, 0.96}}};
  const double at = std::clamp(relative, 0.0, 1.0) * (kTints.size() - 1);
  const size_t below = std::min(static_cast<size_t>(at), kTints.size() - 2);
  return mix(kTints[below], kTints[below + 1], at - static_cast<double>(below));
}

}  // namespace microtin::exporting

#endif
