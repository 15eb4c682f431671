// SPDX-License-Identifier: MIT
// How long a degree is on the ground.
#ifndef MICROTIN_ENCODER_EXPORT_DEGREE_HPP
#define MICROTIN_ENCODER_EXPORT_DEGREE_HPP

#include <algorithm>
#include <cmath>

#include "encoder/layers.hpp"

namespace microtin::exporting {

// Metres along the parallel and along the meridian.
struct Degree {
  double x, y;
};

// On the ellipsoid WGS 84, by series that are right to 0.2 m. Beyond 89 degrees north or south as
// there: at a pole x would be nothing.
inline Degree degree_at(double latitude) {
  constexpr double kRadian = 0.017453292519943295;
  const double angle = std::clamp(latitude, -89.0, 89.0) * kRadian;
  return {111412.84 * std::cos(angle) - 93.5 * std::cos(3 * angle),
          111132.92 - 559.82 * std::cos(2 * angle) + 1.175 * std::cos(4 * angle)};
}

}  // namespace microtin::exporting

#endif
