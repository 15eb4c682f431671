// SPDX-License-Identifier: MIT
// The walk over triangles that both sides of Algorithm 1 share.
#ifndef MICROTIN_TESTS_BENCH_PAPER_WALK_HPP
#define MICROTIN_TESTS_BENCH_PAPER_WALK_HPP

#include <vector>

#include "shared/mesh.hpp"

namespace microtin::bench {

// The half-edge to infinity from the hull vertex where `from` starts.
inline Index edge_to_infinity(const Mesh& mesh, Index from) {
  while (mesh.origin[next_in_triangle(from)] != kInfinity) {
    from = mesh.twin[previous_in_triangle(from)];
  }
  return from;
}

// How a walk proceeds: from triangle to triangle, or from vertex to vertex and around each. The
// paper does not say which of the two it sorts Algorithm 1's batches by.
enum class Walk { kTriangles, kVertices };

// All triangles, breadth first from that of `start`, each by the half-edge it was entered through.
inline std::vector<Index> triangles_breadth_first(const Mesh& mesh, Index start) {
  std::vector<bool> met(mesh.triangles);
  std::vector<Index> found;
  const auto enter = [&](Index h) {
    if (met[triangle_of(h)]) return;
    met[triangle_of(h)] = true;
    found.push_back(h);
  };
  enter(start);
  enter(mesh.twin[start]);
  for (size_t i = 0; i < found.size(); ++i) {
    const Index h = found[i];
    enter(mesh.twin[next_in_triangle(h)]);
    enter(mesh.twin[previous_in_triangle(h)]);
  }
  return found;
}

// All triangles, in the order in which a turn around the end of `start`, and then breadth first
// around its neighbours, meets them; each by a half-edge of its own.
inline std::vector<Index> triangles_around_vertices(const Mesh& mesh, Index start) {
  std::vector<bool> met(mesh.triangles), seen(size_t{mesh.vertices} + 1);
  std::vector<Index> found, queue = {start};
  seen[static_cast<Index>(mesh.origin[next_in_triangle(start)] + 1u)] = true;
  for (size_t i = 0; i < queue.size(); ++i) {
    Index into = queue[i];
    do {
      if (!met[triangle_of(into)]) found.push_back(into);
      met[triangle_of(into)] = true;
      const auto neighbour = static_cast<Index>(mesh.origin[into] + 1u);  // infinity becomes 0
      if (!seen[neighbour]) queue.push_back(mesh.twin[into]);
      seen[neighbour] = true;
      into = mesh.twin[next_in_triangle(into)];
    } while (into != queue[i]);
  }
  return found;
}

inline std::vector<Index> triangles_in_order(const Mesh& mesh, Index start, Walk walk) {
  return walk == Walk::kTriangles ? triangles_breadth_first(mesh, start)
                                  : triangles_around_vertices(mesh, start);
}

}  // namespace microtin::bench

#endif
