// SPDX-License-Identifier: MIT
#include "tests/bench/paper/jump_and_walk.hpp"

#include <cmath>

#include "encoder/stream/triangulation.hpp"
#include "tests/bench/layers.hpp"
#include "tests/support/point_sets.hpp"

namespace microtin::bench {
namespace {

int64_t squared_distance(Point a, Point b) {
  return dot(a - b, a - b);
}

Index nearest_of(const Mesh& mesh, uint32_t samples, Point p, Random& random) {
  Index nearest = 0;
  for (uint32_t i = 0; i < samples; ++i) {
    const Index v = random.below(mesh.vertices);
    const Point candidate = point_of(mesh, v), best = point_of(mesh, nearest);
    if (squared_distance(candidate, p) < squared_distance(best, p)) nearest = v;
  }
  return nearest;
}

}  // namespace

uint64_t jump_and_walk(const std::vector<Point>& points, uint64_t seed) {
  Random random(seed);
  Triangulation triangulation({points[0], points[1], points[2]});
  uint64_t tests = 0;
  for (size_t i = 3; i < points.size(); ++i) {
    const auto samples = static_cast<uint32_t>(std::cbrt(i));
    const Index near = nearest_of(triangulation.mesh(), samples, points[i], random);
    triangulation.insert(points[i], triangulation.edge_of(near));
    // A cavity of m triangles has m + 2 neighbours, and leaves m + 2 triangles.
    tests += 2 * triangulation.new_triangles().size() - 2;
  }
  return tests;
}

}  // namespace microtin::bench
