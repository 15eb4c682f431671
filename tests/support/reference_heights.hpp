// SPDX-License-Identifier: MIT
// What height a terrain has at a place, by definition and with 128-bit numbers: slow, and
// independent of shared/interpolation.hpp.
#ifndef MICROTIN_TESTS_SUPPORT_REFERENCE_HEIGHTS_HPP
#define MICROTIN_TESTS_SUPPORT_REFERENCE_HEIGHTS_HPP

#include <vector>

#include "microtin/microtin.h"
#include "tests/support/layers.hpp"
#include "tests/support/reference_delaunay.hpp"

namespace microtin::tests {
namespace reference {

// floor(numerator / denominator + 1/2), denominator > 0.
inline Wide rounded(Wide numerator, Wide denominator) {
  const Wide twice = 2 * numerator + denominator, divisor = 2 * denominator;
  Wide result = twice / divisor;
  if (twice % divisor < 0) --result;
  return result;
}

// 256 times twice the area of (a, b, p).
inline Wide fine_area(const Vertex& a, const Vertex& b, int32_t x, int32_t y) {
  return (Wide{b.x} - a.x) * (y - Wide{a.y} * 256) - (Wide{b.y} - a.y) * (x - Wide{a.x} * 256);
}

struct Corners {
  Vertex v[3];
  bool is_void;
};

inline std::vector<Corners> real_triangles(const microtin_mesh* mesh) {
  std::vector<Corners> triangles;
  for (uint32_t t = 0; t < microtin_mesh_triangle_count(mesh); ++t) {
    uint32_t v[3];
    const microtin_triangle_kind kind = microtin_mesh_triangle(mesh, t, v);
    if (kind == MICROTIN_TRIANGLE_GHOST) continue;
    Corners corners;
    corners.is_void = kind == MICROTIN_TRIANGLE_VOID;
    for (int i = 0; i < 3; ++i) {
      microtin_mesh_vertex(mesh, v[i], &corners.v[i].x, &corners.v[i].y, &corners.v[i].z);
    }
    triangles.push_back(corners);
  }
  return triangles;
}

// Whether a place lies in the closed triangle.
inline bool holds(const Corners& t, int32_t x, int32_t y) {
  return fine_area(t.v[0], t.v[1], x, y) >= 0 && fine_area(t.v[1], t.v[2], x, y) >= 0 &&
         fine_area(t.v[2], t.v[0], x, y) >= 0;
}

// The height of the triangle's plane at a place.
inline int32_t height_in(const Corners& t, int32_t x, int32_t y) {
  const Wide a = fine_area(t.v[1], t.v[2], x, y), b = fine_area(t.v[2], t.v[0], x, y),
             c = fine_area(t.v[0], t.v[1], x, y);
  const Wide sum = a * t.v[0].z + b * t.v[1].z + c * t.v[2].z;
  return static_cast<int32_t>(rounded(sum * 65536, a + b + c));
}

}  // namespace reference
}  // namespace microtin::tests

#endif
