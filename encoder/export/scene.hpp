// SPDX-License-Identifier: MIT
// What meshes and pictures are made of: vectors, metres, and colours of heights. Nothing exact is
// made of them.
#ifndef MICROTIN_ENCODER_EXPORT_SCENE_HPP
#define MICROTIN_ENCODER_EXPORT_SCENE_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "encoder/layers.hpp"

namespace microtin::exporting {

struct Vector {
  double x, y, z;
};

inline Vector operator+(Vector a, Vector b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

inline Vector operator-(Vector a, Vector b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

inline Vector operator*(double s, Vector a) {
  return {s * a.x, s * a.y, s * a.z};
}

inline double dot(Vector a, Vector b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline Vector cross_product(Vector a, Vector b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline Vector normalised(Vector a) {
  return 1 / std::sqrt(dot(a, a)) * a;
}

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
