// SPDX-License-Identifier: MIT
// Finding the triangle that holds a place.
#ifndef MICROTIN_DECODER_WALK_HPP
#define MICROTIN_DECODER_WALK_HPP

#include "shared/interpolation.hpp"
#include "shared/mesh.hpp"

namespace microtin {

// Positive if p lies to the left of a half-edge, negative if to the right; `next` is the half-edge
// after it, and both start at finite vertices.
inline int64_t side_of(const Mesh& mesh, Index half_edge, Index next, FinePoint p) {
  return orient_fine(point_of(mesh, mesh.origin[half_edge]), point_of(mesh, mesh.origin[next]), p);
}

// Walks from *triangle to the triangle that holds p, through at most `step_limit` triangles:
// crosses any edge that p lies beyond. *triangle becomes where the walk ended, a ghost if p is
// outside the hull; false if the steps did not suffice.
//
// mesh.triangles steps always suffice, also in several calls. Lift the vertices to the paraboloid,
// with the infinitesimals of conflicts_on_circle: the triangles become facets of a strictly convex
// surface, and each step makes the facet's plane higher above p. So no triangle is met twice
// (Edelsbrunner, "An acyclicity theorem for cell complexes in d dimensions", 1990).
bool walk_to(const Mesh& mesh, FinePoint p, uint32_t step_limit, Index* triangle);

}  // namespace microtin

#endif
