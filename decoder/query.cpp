// SPDX-License-Identifier: MIT
// Queries on a decoded mesh.
#include "decoder/axis.hpp"
#include "decoder/state.hpp"
#include "decoder/walk.hpp"
#include "shared/digest.hpp"
#include "shared/header.hpp"

namespace microtin {
namespace {

uint32_t public_vertex(Index v) {
  return v == kInfinity ? static_cast<uint32_t>(MICROTIN_VERTEX_AT_INFINITY) : v;
}

}  // namespace
}  // namespace microtin

using namespace microtin;

uint32_t microtin_mesh_vertex_count(const microtin_mesh* mesh) {
  return mesh->mesh.vertices;
}

void microtin_mesh_vertex(const microtin_mesh* mesh, uint32_t v, uint16_t* x, uint16_t* y,
                          int16_t* z) {
  MICROTIN_ASSERT(v < mesh->mesh.vertices);
  const Point at = mesh->mesh.place[v];
  *x = at.x;
  *y = at.y;
  *z = mesh->mesh.z[v];
}

uint32_t microtin_mesh_triangle_count(const microtin_mesh* mesh) {
  return mesh->mesh.triangles;
}

microtin_triangle_kind microtin_mesh_triangle(const microtin_mesh* mesh, uint32_t t,
                                              uint32_t v[3]) {
  MICROTIN_ASSERT(t < mesh->mesh.triangles);
  const Index f = first_edge(static_cast<Index>(t));
  for (uint32_t i = 0; i < 3; ++i) v[i] = public_vertex(mesh->mesh.origin[f + i]);
  if (is_ghost(mesh->mesh, static_cast<Index>(t))) return MICROTIN_TRIANGLE_GHOST;
  return has_terrain(*mesh, static_cast<Index>(t)) ? MICROTIN_TRIANGLE_REAL
                                                   : MICROTIN_TRIANGLE_VOID;
}

uint32_t microtin_mesh_neighbour(const microtin_mesh* mesh, uint32_t t, uint32_t corner) {
  MICROTIN_ASSERT(t < mesh->mesh.triangles && corner < 3);
  const Index f = first_edge(static_cast<Index>(t));
  return triangle_of(mesh->mesh.twin[static_cast<Index>(f + corner)]);
}

uint64_t microtin_mesh_digest(const microtin_mesh* mesh) {
  uint64_t sum = 0;
  for (Index t = 0; t < mesh->mesh.triangles; ++t) {
    if (is_ghost(mesh->mesh, t)) continue;
    const Index* const v = mesh->mesh.origin + first_edge(t);
    Vertex corner[3];
    for (uint32_t i = 0; i < 3; ++i) corner[i] = vertex_of(mesh->mesh, v[i]);
    sum += triangle_digest(corner, !has_terrain(*mesh, t));
  }
  return sum;
}

microtin_query_result microtin_mesh_height_at(const microtin_mesh* mesh, int32_t x, int32_t y,
                                              uint32_t* hint, int32_t* height, uint32_t flags,
                                              uint32_t step_limit) {
  const Mesh& m = mesh->mesh;
  const microtin_query_result refusal = refusal_of(*mesh, flags);
  if (refusal != MICROTIN_QUERY_OK) return refusal;
  if (!is_on_lattice(x, y)) return MICROTIN_QUERY_OUTSIDE;
  const FinePoint p = {x, y};
  Index t = *hint < m.triangles ? static_cast<Index>(*hint) : static_cast<Index>(0);
  const bool arrived = walk_to(*mesh, p, step_limit == 0 ? m.triangles : step_limit, &t);
  *hint = t;
  if (!arrived) return MICROTIN_QUERY_STEP_LIMIT;
  if (is_ghost(m, t)) return MICROTIN_QUERY_OUTSIDE;
  return result_at(MeshCursor(*mesh, first_edge(t)), p, height);
}

microtin_query_result microtin_mesh_safe_heights_at(const microtin_mesh* mesh, int32_t x, int32_t y,
                                                    uint32_t* hint, microtin_safe_heights* heights,
                                                    uint32_t flags, uint32_t step_limit) {
  int32_t height = 0;
  const microtin_query_result found =
      microtin_mesh_height_at(mesh, x, y, hint, &height, flags, step_limit);
  return found == MICROTIN_QUERY_OK ? widen(height, mesh->below, mesh->above, heights) : found;
}

void microtin_mesh_margins(const microtin_mesh* mesh, uint32_t* below, uint32_t* above) {
  *below = mesh->below;
  *above = mesh->above;
}

void microtin_mesh_axes(const microtin_mesh* mesh, microtin_axis* x, microtin_axis* y,
                        microtin_axis* z) {
  microtin_axis axis[3];
  place_on_lattice(axis);
  const microtin_axis* const known = mesh->is_placed ? mesh->axis : axis;
  *x = known[0];
  *y = known[1];
  *z = known[2];
}

microtin_status microtin_axis_to_lattice(const microtin_axis* axis, int64_t value,
                                         uint32_t per_unit, int32_t* lattice) {
  // Numerators are below 2^40.
  const int64_t found = half_steps(*axis, kLatticeMax, value, per_unit);
  if (found < -1) return MICROTIN_STATUS_OUT_OF_RANGE;
  *lattice = static_cast<int32_t>(rounded_steps(found));
  return MICROTIN_STATUS_OK;
}
