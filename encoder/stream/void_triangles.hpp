// SPDX-License-Identifier: MIT
// A TIN's void triangles, found again in its triangulation.
#ifndef MICROTIN_ENCODER_STREAM_VOID_TRIANGLES_HPP
#define MICROTIN_ENCODER_STREAM_VOID_TRIANGLES_HPP

#include <algorithm>
#include <set>
#include <tuple>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/terrain/survey.hpp"
#include "shared/mesh.hpp"

namespace microtin::stream {

// A triangle as a TIN lists it.
inline Tin::Triangle listed_triangle(const Mesh& mesh, Index triangle) {
  const Index f = first_edge(triangle);
  Point p[3];
  for (Index i = 0; i < 3; ++i) p[i] = point_of(mesh, mesh.origin[f + i]);
  std::rotate(p, std::min_element(p, p + 3), p + 3);
  return {p[0], p[1], p[2]};
}

class VoidTriangles {
 public:
  explicit VoidTriangles(const std::vector<Tin::Triangle>& voids) {
    for (const Tin::Triangle& t : voids) voids_.emplace(t.a, t.b, t.c);
  }

  bool empty() const { return voids_.empty(); }
  bool has(const Mesh& mesh, Index triangle) const {
    if (empty()) return false;
    const Tin::Triangle t = listed_triangle(mesh, triangle);
    return voids_.count({t.a, t.b, t.c}) != 0;
  }

 private:
  std::set<std::tuple<Point, Point, Point>> voids_;
};

}  // namespace microtin::stream

#endif
