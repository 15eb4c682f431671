#include "encoder/order.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace microtin {
namespace {

// All vertices but infinity, breadth first from infinity by way of `first`; around each vertex
// clockwise from the edge to its parent.
std::vector<Index> breadth_first(const Triangulation& triangulation, Index first) {
  const Mesh& mesh = triangulation.mesh();
  std::vector<Index> arrivals;  // half-edges parent -> vertex
  std::vector<bool> queued(mesh.vertices, false);
  const auto walk_around = [&](Index arrival) {
    // Half-edges into the vertex, clockwise: the parent's comes first.
    Index into = arrival;
    do {
      const Index neighbour = mesh.origin[into];
      if (neighbour != kInfinity && !queued[neighbour]) {
        queued[neighbour] = true;
        arrivals.push_back(mesh.twin[into]);
      }
      into = mesh.twin[next_in_triangle(into)];
    } while (into != arrival);
  };
  Index from_infinity = triangulation.edge_of(kInfinity);
  while (mesh.origin[next_in_triangle(from_infinity)] != first) {
    from_infinity = mesh.twin[previous_in_triangle(from_infinity)];
  }
  walk_around(mesh.twin[from_infinity]);
  for (size_t i = 0; i < arrivals.size(); ++i) walk_around(arrivals[i]);
  std::vector<Index> vertices(arrivals.size());
  std::transform(arrivals.begin(), arrivals.end(), vertices.begin(),
                 [&](Index h) { return mesh.origin[next_in_triangle(h)]; });
  return vertices;
}

// The smallest point, the largest, and the one farthest from the line through them (of several the
// smallest): never removed, so that the set keeps a triangle.
std::array<Index, 3> choose_seed(const Mesh& mesh) {
  Index least = 0, most = 0, far = 0;
  for (Index v = 1; v < mesh.vertices; ++v) {
    if (point_of(mesh, v) < point_of(mesh, least)) least = v;
    if (point_of(mesh, most) < point_of(mesh, v)) most = v;
  }
  const auto distance = [&](Index v) {
    return orient2d(point_of(mesh, least), point_of(mesh, most), point_of(mesh, v));
  };
  for (Index v = 0; v < mesh.vertices; ++v) {
    const int64_t d = std::abs(distance(v)), best = std::abs(distance(far));
    if (d > best || (d == best && point_of(mesh, v) < point_of(mesh, far))) far = v;
  }
  if (distance(far) > 0) return {least, most, far};
  return {least, far, most};
}

// The vertex farthest from the seed's longest side on its other side, or a vertex of the seed. It
// goes last: of a rectangle the seed has only three corners, and without the fourth, points on two
// borders would lie outside the hull, where places are dear.
Index opposite_corner(const Mesh& mesh, const std::array<Index, 3>& seed) {
  const Point least = point_of(mesh, seed[0]);
  const bool to_left = point_of(mesh, seed[1]) < point_of(mesh, seed[2]);
  const Point most = point_of(mesh, seed[to_left ? 2 : 1]);
  Index far = seed[0];
  int64_t best = 0;
  for (Index v = 0; v < mesh.vertices; ++v) {
    const int64_t d = orient2d(least, most, point_of(mesh, v)) * (to_left ? 1 : -1);
    if (d > best) {
      far = v;
      best = d;
    }
  }
  return far;
}

constexpr Index kFewVertices = 48;

}  // namespace

Order breadth_first_order(Triangulation& triangulation, uint32_t degree) {
  Order order;
  order.seed = choose_seed(triangulation.mesh());
  const auto in_seed = [&](Index v) {
    return std::find(order.seed.begin(), order.seed.end(), v) != order.seed.end();
  };
  const Index last = opposite_corner(triangulation.mesh(), order.seed);
  Index left = triangulation.mesh().vertices;
  while (left > 3) {
    const std::vector<Index> vertices = breadth_first(triangulation, order.seed[0]);
    std::vector<Index> batch;
    for (auto v = vertices.rbegin(); v != vertices.rend(); ++v) {
      if (*v == last && left > kFewVertices) continue;
      if (in_seed(*v) || triangulation.degree(*v) > degree) continue;
      triangulation.remove(*v);
      batch.push_back(*v);
    }
    left -= static_cast<Index>(batch.size());
    std::reverse(batch.begin(), batch.end());
    order.batches.push_back(std::move(batch));
  }
  std::reverse(order.batches.begin(), order.batches.end());
  return order;
}

}  // namespace microtin
