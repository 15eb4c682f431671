// SPDX-License-Identifier: MIT
// Segments and blocks on a compact terrain.
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
