// SPDX-License-Identifier: MIT
// CGAL: its Delaunay triangulation with exact predicates behind floating-point filters.
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "tests/bench/peers/peers.hpp"

namespace microtin::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

size_t count_triangles(const std::vector<Vertex>& vertices) {
  std::vector<Kernel::Point_2> points;
  points.reserve(vertices.size());
  for (const Vertex& v : vertices) points.emplace_back(v.x, v.y);
  const CGAL::Delaunay_triangulation_2<Kernel> triangulation(points.begin(), points.end());
  return triangulation.number_of_faces();
}

}  // namespace

Triangulator cgal() {
  return {"CGAL", count_triangles};
}

}  // namespace microtin::bench
