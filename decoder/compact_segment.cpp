// SPDX-License-Identifier: MIT
// Segments, blocks and gradients on a compact terrain.
#include "decoder/gradient.hpp"
#include "decoder/terrain_forms.hpp"
#include "decoder/terrain_query.hpp"

using namespace microtin;

microtin_query_result microtin_compact_segment_extremes(const microtin_compact* compact,
                                                        const microtin_segment* segment,
                                                        microtin_segment_state* state,
                                                        microtin_segment_extremes* extremes,
                                                        uint32_t step_limit) {
  return extremes_in_terrain(RingForm(compact), *segment, state, extremes, step_limit);
}

microtin_query_result microtin_compact_profile_next(const microtin_compact* compact,
                                                    const microtin_segment* segment,
                                                    microtin_segment_state* state,
                                                    microtin_crossing* crossing,
                                                    uint32_t step_limit) {
  return next_in_profile(RingForm(compact), *segment, state, crossing, step_limit);
}

microtin_query_result microtin_compact_path_clearance(const microtin_compact* compact,
                                                      const microtin_path* path,
                                                      microtin_segment_state* state,
                                                      microtin_path_clearance* clearance,
                                                      uint32_t flags, uint32_t step_limit) {
  return clearance_in_terrain(RingForm(compact), *path, state, clearance, flags, step_limit);
}

microtin_query_result microtin_compact_sample_grid(const microtin_compact* compact,
                                                   const microtin_grid_spec* grid,
                                                   int16_t* heights) {
  return fill_from_terrain(RingForm(compact), compact->axis[2], *grid, heights);
}

microtin_query_result microtin_compact_gradient_at(const microtin_compact* compact, int32_t x,
                                                   int32_t y, uint32_t* hint,
                                                   microtin_gradient* gradient,
                                                   uint32_t step_limit) {
  return gradient_in_terrain(RingForm(compact), x, y, hint, gradient, step_limit);
}

microtin_query_result microtin_compact_heights_at(const microtin_compact* compact,
                                                  const microtin_position* positions,
                                                  uint32_t count, uint32_t* hint,
                                                  int32_t* heights) {
  return heights_at(positions, count, HeightInTerrain<RingForm>(RingForm(compact)), hint, heights);
}

microtin_query_result microtin_compact_grid_extremes(const microtin_compact* compact,
                                                     const microtin_grid_spec* grid,
                                                     microtin_grid_extremes* extremes) {
  return grid_extremes(*grid, HeightInTerrain<RingForm>(RingForm(compact)), extremes);
}
