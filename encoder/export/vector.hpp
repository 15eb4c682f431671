// SPDX-License-Identifier: MIT
// Vectors for pictures and meshes: nothing exact is made of them.
#ifndef MICROTIN_ENCODER_EXPORT_VECTOR_HPP
#define MICROTIN_ENCODER_EXPORT_VECTOR_HPP

#include <cmath>

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

}  // namespace microtin::exporting

#endif
