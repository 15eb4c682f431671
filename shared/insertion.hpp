// Insertion of one point into a Delaunay mesh: grow the cavity of conflicting triangles, then fan
// it from the new vertex.
#ifndef MICROTIN_SHARED_INSERTION_HPP
#define MICROTIN_SHARED_INSERTION_HPP

#include "shared/mesh.hpp"

namespace microtin {

// Scratch for one insertion; its arrays belong to the caller. A cavity of m triangles is a polygon
// of m + 2 edges.
struct Cavity {
  Index* triangles;    // limit entries: the slots to be reused
  Index* edge_origin;  // limit + 2 entries: boundary, counter-clockwise
  Index* edge_twin;    // limit + 2 entries: the half-edges across it
  Index* pending;      // limit + 2 entries: boundary edges not yet tested
  Index limit;         // most triangles that fit
  Index size;          // triangles found
};

// Collects the triangles in conflict with p, given that the triangle of `start` is one. If the
// half-edge `start` stays on the boundary, it comes first there. `forbids(h)` is asked for each
// further triangle, entered through its half-edge h, before it joins. False if it says yes, or if
// the cavity outgrows its limit.
//
// The cavity's dual graph is a tree (its union is star-shaped from p and no vertex lies inside), so
// no triangle is met twice; each turn of the loop uses up one boundary edge of at most limit + 2.
template <class Forbids>
bool grow_cavity(const Mesh& mesh, Index start, Point p, Cavity& cavity, const Forbids& forbids) {
  cavity.triangles[0] = triangle_of(start);
  cavity.size = 1;
  Index edges = 0;
  Index waiting = 0;
  cavity.pending[waiting++] = previous_in_triangle(start);
  cavity.pending[waiting++] = next_in_triangle(start);
  cavity.pending[waiting++] = start;
  while (waiting != 0) {
    const Index edge = cavity.pending[--waiting];
    const Index across = mesh.twin[edge];
    if (!in_conflict(mesh, across, p)) {
      cavity.edge_origin[edges] = mesh.origin[edge];
      cavity.edge_twin[edges++] = across;
      continue;
    }
    if (cavity.size == cavity.limit) return false;
    if (forbids(across)) return false;
    cavity.triangles[cavity.size++] = triangle_of(across);
    cavity.pending[waiting++] = previous_in_triangle(across);
    cavity.pending[waiting++] = next_in_triangle(across);
  }
  return true;
}

// Replaces the cavity by a fan around the new vertex v: one triangle (edge origin, next origin, v)
// per boundary edge, in boundary order; the cavity's own slots first, then mesh.triangles and the
// one after it. Returns the first half-edge of the first fan triangle. The caller counts the
// vertex.
inline Index fan_cavity(Mesh& mesh, const Cavity& cavity, Index v) {
  const Index edges = static_cast<Index>(cavity.size + 2u);
  const Index fresh = mesh.triangles;
  mesh.triangles = static_cast<Index>(mesh.triangles + 2u);
  Index previous = 0;
  Index first = 0;
  for (Index i = 0; i < edges; ++i) {
    const Index slot =
        i < cavity.size ? cavity.triangles[i] : static_cast<Index>(fresh + (i - cavity.size));
    const Index h = first_edge(slot);
    mesh.origin[h] = cavity.edge_origin[i];
    mesh.origin[h + 1u] = cavity.edge_origin[i + 1u == edges ? 0 : i + 1u];
    mesh.origin[h + 2u] = v;
    pair(mesh, h, cavity.edge_twin[i]);
    if (i == 0) {
      first = h;
    } else {
      pair(mesh, static_cast<Index>(previous + 1u), static_cast<Index>(h + 2u));
    }
    previous = h;
  }
  pair(mesh, static_cast<Index>(previous + 1u), static_cast<Index>(first + 2u));
  return first;
}

}  // namespace microtin

#endif
