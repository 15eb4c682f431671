// SPDX-License-Identifier: MIT
// Whether a mesh is the canonical triangulation, by rules between neighbours alone: linear, for
// every run of a target. Independent of shared/predicates.hpp.
#ifndef MICROTIN_FUZZ_SUPPORT_LOCAL_DELAUNAY_HPP
#define MICROTIN_FUZZ_SUPPORT_LOCAL_DELAUNAY_HPP

#include "shared/mesh.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/reference_delaunay.hpp"

namespace microtin::tests {

inline bool is_paired(const Mesh& mesh, Index h) {
  const Index twin = mesh.twin[h], end = mesh.origin[next_in_triangle(h)];
  return twin < first_edge(mesh.triangles) && mesh.twin[twin] == h && mesh.origin[twin] == end &&
         (mesh.origin[h] == kInfinity || mesh.origin[h] < mesh.vertices) && mesh.origin[h] != end;
}

// Whether the triangle of h is free of the far corner of the one across h.
inline bool is_free_of_neighbour(const Mesh& mesh, Index h) {
  const Index far = mesh.origin[previous_in_triangle(mesh.twin[h])];
  if (far == kInfinity) return true;
  const Index v[3] = {mesh.origin[h], mesh.origin[next_in_triangle(h)],
                      mesh.origin[previous_in_triangle(h)]};
  const Point p = point_of(mesh, far);
  for (int i = 0; i < 3; ++i) {
    if (v[i] != kInfinity) continue;
    return !reference::spoils_hull_edge(point_of(mesh, v[(i + 1) % 3]),
                                        point_of(mesh, v[(i + 2) % 3]), p);
  }
  return !reference::in_perturbed_circle(point_of(mesh, v[0]), point_of(mesh, v[1]),
                                         point_of(mesh, v[2]), p);
}

// Whether h, which comes from infinity, leads to a hull vertex smaller than both next to it.
inline bool starts_hull(const Mesh& mesh, Index h) {
  const Point p = point_of(mesh, mesh.origin[next_in_triangle(h)]);
  return p < point_of(mesh, mesh.origin[previous_in_triangle(h)]) &&
         p < point_of(mesh, mesh.origin[previous_in_triangle(mesh.twin[h])]);
}

// Counter-clockwise triangles without a neighbour in conflict, within a hull that turns only one
// way and only once, are the canonical triangulation (Delaunay's lemma), if the mesh is a surface.
inline bool is_locally_delaunay(const Mesh& mesh) {
  if (mesh.triangles + 2 != 2 * mesh.vertices) return false;
  const Index edges = first_edge(mesh.triangles);
  for (Index h = 0; h < edges; ++h) {
    if (!is_paired(mesh, h)) return false;
  }
  Index hull_starts = 0;
  for (Index h = 0; h < edges; ++h) {
    if (!is_free_of_neighbour(mesh, h)) return false;
    if (mesh.origin[h] == kInfinity) {
      hull_starts += starts_hull(mesh, h) ? 1 : 0;
    } else if (h % 3 == 0 && !is_ghost(mesh.origin[h], mesh.origin[h + 1], mesh.origin[h + 2]) &&
               reference::area(point_of(mesh, mesh.origin[h]), point_of(mesh, mesh.origin[h + 1]),
                               point_of(mesh, mesh.origin[h + 2])) <= 0) {
      return false;
    }
  }
  return hull_starts == 1;
}

}  // namespace microtin::tests

#endif
