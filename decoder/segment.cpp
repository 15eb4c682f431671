// SPDX-License-Identifier: MIT
// Segments, blocks and gradients on a decoded mesh.
#include "decoder/gradient.hpp"
#include "decoder/terrain_forms.hpp"
#include "decoder/terrain_query.hpp"

using namespace microtin;

microtin_query_result microtin_mesh_segment_extremes(const microtin_mesh* mesh,
                                                     const microtin_segment* segment,
                                                     microtin_segment_state* state,
                                                     microtin_segment_extremes* extremes,
                                                     uint32_t step_limit) {
  clear(extremes);
  const microtin_query_result refusal = refusal_of(*mesh, 0);
  if (refusal != MICROTIN_QUERY_OK) return refusal;
  return extremes_in_terrain(MeshForm(mesh), *segment, state, extremes, step_limit);
}

microtin_query_result microtin_mesh_profile_next(const microtin_mesh* mesh,
                                                 const microtin_segment* segment,
                                                 microtin_segment_state* state,
                                                 microtin_crossing* crossing, uint32_t step_limit) {
  const microtin_query_result refusal = refusal_of(*mesh, 0);
  if (refusal != MICROTIN_QUERY_OK) return refusal;
  return next_in_profile(MeshForm(mesh), *segment, state, crossing, step_limit);
}

microtin_query_result microtin_mesh_path_clearance(const microtin_mesh* mesh,
                                                   const microtin_path* path,
                                                   microtin_segment_state* state,
                                                   microtin_path_clearance* clearance,
                                                   uint32_t flags, uint32_t step_limit) {
  clear(clearance);
  const microtin_query_result refusal = refusal_of(*mesh, flags);
  if (refusal != MICROTIN_QUERY_OK) return refusal;
  return clearance_in_terrain(MeshForm(mesh, flags), *path, state, clearance, flags, step_limit);
}

microtin_query_result microtin_mesh_sample_grid(const microtin_mesh* mesh,
                                                const microtin_grid_spec* grid, int16_t* heights) {
  microtin_axis axis[3];
  microtin_mesh_axes(mesh, &axis[0], &axis[1], &axis[2]);
  return fill_from_terrain(MeshForm(mesh), axis[2], *grid, heights);
}

microtin_query_result microtin_mesh_gradient_at(const microtin_mesh* mesh, int32_t x, int32_t y,
                                                uint32_t* hint, microtin_gradient* gradient,
                                                uint32_t flags, uint32_t step_limit) {
  return gradient_in_terrain(MeshForm(mesh, flags), x, y, hint, gradient, step_limit);
}

microtin_query_result microtin_mesh_heights_at(const microtin_mesh* mesh,
                                               const microtin_position* positions, uint32_t count,
                                               uint32_t* hint, int32_t* heights) {
  return heights_at(positions, count, HeightInTerrain<MeshForm>(MeshForm(mesh)), hint, heights);
}

microtin_query_result microtin_mesh_grid_extremes(const microtin_mesh* mesh,
                                                  const microtin_grid_spec* grid,
                                                  microtin_grid_extremes* extremes) {
  return grid_extremes(*grid, HeightInTerrain<MeshForm>(MeshForm(mesh)), extremes);
}
