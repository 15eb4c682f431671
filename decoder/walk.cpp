// SPDX-License-Identifier: MIT
#include "decoder/walk.hpp"

namespace microtin {
namespace {

// A half-edge of the triangle or, from a ghost, of the real one beside it.
Index real_edge(const Mesh& mesh, Index triangle) {
  Index h = first_edge(triangle);
  if (!is_ghost(mesh, triangle)) return h;
  while (mesh.origin[h] == kInfinity || mesh.origin[next_in_triangle(h)] == kInfinity) ++h;
  return mesh.twin[h];
}

}  // namespace

bool walk_to(const Mesh& mesh, FinePoint p, uint32_t step_limit, Index* triangle) {
  Index h = real_edge(mesh, *triangle);
  if (side_of(mesh, h, next_in_triangle(h), p) < 0) h = mesh.twin[h];
  bool arrived = false;
  for (uint32_t step = 0; step < step_limit && !arrived; ++step) {
    // p does not lie beyond h.
    const Index next = next_in_triangle(h), last = next_in_triangle(next);
    const bool real = mesh.origin[last] != kInfinity;
    if (real && side_of(mesh, next, last, p) < 0) {
      h = mesh.twin[next];
    } else if (real && side_of(mesh, last, h, p) < 0) {
      h = mesh.twin[last];
    } else {
      arrived = true;
    }
  }
  *triangle = triangle_of(h);
  return arrived;
}

}  // namespace microtin
