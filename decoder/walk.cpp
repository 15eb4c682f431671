// SPDX-License-Identifier: MIT
// The walk through a mesh, compiled once for all queries of meshes.
#include "decoder/walk.hpp"

namespace microtin {
namespace {

// A half-edge of the triangle or, from a ghost, of the real one next to it.
Index real_edge(const Mesh& mesh, Index triangle) {
  Index h = first_edge(triangle);
  if (!is_ghost(mesh, triangle)) return h;
  while (mesh.origin[h] == kInfinity || mesh.origin[next_in_triangle(h)] == kInfinity) ++h;
  return mesh.twin[h];
}

}  // namespace

MICROTIN_WITHOUT_CALLS bool walk_to(const microtin_mesh& mesh, FinePoint p, uint32_t step_limit,
                                    Index* triangle) {
  MeshCursor cursor(mesh, real_edge(mesh.mesh, *triangle));
  const bool arrived = walk(cursor, p, step_limit);
  *triangle = cursor.triangle();
  return arrived;
}

}  // namespace microtin
