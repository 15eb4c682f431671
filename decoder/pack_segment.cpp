// SPDX-License-Identifier: MIT
// Segments and blocks on packs whose tiles are meshes: linked only where they are used, also by
// linkers that keep all of a file.
#include "decoder/pack_profile.hpp"
#include "decoder/pack_query.hpp"
#include "decoder/terrain_forms.hpp"

using namespace microtin;

microtin_query_result microtin_pack_segment_extremes(const microtin_pack* pack,
                                                     const microtin_segment* segment,
                                                     microtin_segment_extremes* extremes) {
  return extremes_in_pack<MeshForm>(*pack, *segment, extremes);
}

microtin_query_result microtin_pack_profile_next(const microtin_pack* pack,
                                                 const microtin_segment* segment,
                                                 microtin_segment_state* state,
                                                 microtin_crossing* crossing) {
  return next_in_pack<MeshForm>(*pack, *segment, state, crossing);
}

microtin_query_result microtin_pack_path_clearance(const microtin_pack* pack,
                                                   const microtin_path* path,
                                                   microtin_path_clearance* clearance,
                                                   uint32_t flags) {
  return clearance_in_pack<MeshForm>(*pack, *path, clearance, flags);
}

microtin_query_result microtin_pack_sample_grid(const microtin_pack* pack,
                                                const microtin_grid_spec* grid, int16_t* heights) {
  return fill_from_pack<MeshForm>(*pack, *grid, heights);
}

microtin_query_result microtin_pack_gradient_at(const microtin_pack* pack, int64_t x, int64_t y,
                                                uint32_t* hint, microtin_gradient* gradient) {
  return gradient_in_pack<MeshForm>(*pack, x, y, hint, gradient);
}

microtin_query_result microtin_pack_heights_at(const microtin_pack* pack,
                                               const microtin_position* positions, uint32_t count,
                                               uint32_t* hint, int32_t* heights) {
  return heights_at(positions, count, HeightInPack<MeshForm>(*pack), hint, heights);
}

microtin_query_result microtin_pack_grid_extremes(const microtin_pack* pack,
                                                  const microtin_grid_spec* grid,
                                                  microtin_grid_extremes* extremes) {
  return grid_extremes(*grid, HeightInPack<MeshForm>(*pack), extremes);
}
