// SPDX-License-Identifier: MIT
// Whether a half-edge mesh is a triangulation at all, whatever its triangles are.
#ifndef MICROTIN_TESTS_SUPPORT_MESH_CHECKS_HPP
#define MICROTIN_TESTS_SUPPORT_MESH_CHECKS_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "shared/mesh.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/reference_delaunay.hpp"

namespace microtin::tests {

// A slot that holds no triangle: two of its origins are the same.
inline bool is_free_slot(const Mesh& mesh, Index triangle) {
  return mesh.origin[first_edge(triangle)] == mesh.origin[first_edge(triangle) + 1u];
}

inline std::vector<Index> live_triangles(const Mesh& mesh) {
  std::vector<Index> live;
  for (Index t = 0; t < mesh.triangles; ++t) {
    if (!is_free_slot(mesh, t)) live.push_back(t);
  }
  return live;
}

// The half-edge of triangle t that starts at infinity, or kInfinity if t is real.
inline Index infinite_edge(const Mesh& mesh, Index t) {
  for (Index h = first_edge(t); h < first_edge(t) + 3u; ++h) {
    if (mesh.origin[h] == kInfinity) return h;
  }
  return kInfinity;
}

inline TriangleSet triangles_of(const Mesh& mesh) {
  TriangleSet set;
  for (const Index t : live_triangles(mesh)) {
    const Index ghost = infinite_edge(mesh, t);
    const Index first = ghost == kInfinity ? first_edge(t) : next_in_triangle(ghost);
    const Point a = point_of(mesh, mesh.origin[first]);
    const Point b = point_of(mesh, mesh.origin[next_in_triangle(first)]);
    if (ghost == kInfinity) {
      set.add_triangle(a, b, point_of(mesh, mesh.origin[previous_in_triangle(first)]));
    } else {
      set.add_hull_edge(a, b);
    }
  }
  set.sort();
  return set;
}

// Twins are mutual, connect the same two vertices, and belong to different triangles; no vertex
// appears twice in a triangle.
inline std::string pairing_fault(const Mesh& mesh) {
  for (const Index t : live_triangles(mesh)) {
    for (Index h = first_edge(t); h < first_edge(t) + 3u; ++h) {
      const std::string name = " at half-edge " + std::to_string(h);
      const Index twin = mesh.twin[h], end = mesh.origin[next_in_triangle(h)];
      if (twin >= first_edge(mesh.triangles)) return "twin out of range" + name;
      if (is_free_slot(mesh, triangle_of(twin))) return "twin in a free slot" + name;
      if (mesh.twin[twin] != h) return "twins not mutual" + name;
      if (triangle_of(twin) == t) return "triangle glued to itself" + name;
      if (mesh.origin[twin] != end) return "twins differ in their ends" + name;
      if (mesh.origin[h] == end) return "edge without length" + name;
      if (mesh.origin[h] != kInfinity && mesh.origin[h] >= mesh.vertices) {
        return "no such vertex" + name;
      }
    }
  }
  return "";
}

// The triangles around each vertex, infinity included, form a single ring.
inline std::string ring_fault(const Mesh& mesh, Index vertices) {
  std::vector<bool> seen(first_edge(mesh.triangles)), reached(mesh.vertices + std::size_t{1});
  std::size_t rings = 0;
  for (const Index t : live_triangles(mesh)) {
    for (Index start = first_edge(t); start < first_edge(t) + 3u; ++start) {
      if (seen[start]) continue;
      const Index v = mesh.origin[start] == kInfinity ? mesh.vertices : mesh.origin[start];
      if (reached[v]) return "two rings around vertex " + std::to_string(mesh.origin[start]);
      reached[v] = true;
      ++rings;
      for (Index h = start; !seen[h]; h = mesh.twin[previous_in_triangle(h)]) seen[h] = true;
    }
  }
  return rings == std::size_t{vertices} + 1 ? "" : std::to_string(rings) + " vertices reached";
}

// Real triangles turn counter-clockwise and fill the hull.
inline std::string area_fault(const Mesh& mesh) {
  const TriangleSet set = triangles_of(mesh);
  reference::Wide triangles = 0, hull = 0;
  for (const auto& [a, b, c] : set.triangles) {
    const reference::Wide area = reference::area(a, b, c);
    if (area <= 0) return "a triangle is not counter-clockwise";
    triangles += area;
  }
  for (const auto& [u, w] : set.hull) hull += reference::area(Point{0, 0}, w, u);
  return triangles == hull ? "" : "the triangles do not add up to the hull";
}

// Empty, or the first thing that is wrong with a mesh of that many vertices. A mesh without fault
// is one sphere (Euler) whose real triangles cover the hull once.
inline std::string mesh_fault(const Mesh& mesh, Index vertices) {
  const std::size_t triangles = live_triangles(mesh).size();
  if (triangles + 2 != 2 * std::size_t{vertices}) return std::to_string(triangles) + " triangles";
  std::string fault = pairing_fault(mesh);
  if (fault.empty()) fault = ring_fault(mesh, vertices);
  if (fault.empty()) fault = area_fault(mesh);
  return fault;
}

}  // namespace microtin::tests

#endif
