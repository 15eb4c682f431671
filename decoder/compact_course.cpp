// SPDX-License-Identifier: MIT
// Courses and blocks on a compact terrain.
#include "decoder/ring_form.hpp"
#include "decoder/terrain_query.hpp"

using namespace microtin;

microtin_query_result microtin_compact_segment_max(const microtin_compact* compact,
                                                   const microtin_segment* course,
                                                   int32_t* height) {
  microtin_segment_state progress = {};
  return microtin_compact_segment_max_limited(compact, course, 0, &progress, height);
}

microtin_query_result microtin_compact_segment_max_limited(const microtin_compact* compact,
                                                           const microtin_segment* course,
                                                           uint32_t step_limit,
                                                           microtin_segment_state* progress,
                                                           int32_t* height) {
  return highest_in_terrain(RingForm(compact), *course, step_limit, progress, height);
}

microtin_query_result microtin_compact_sample_grid(const microtin_compact* compact,
                                                   const microtin_grid_spec* block,
                                                   int16_t* heights) {
  return fill_from_terrain(RingForm(compact), compact->axis[2], *block, heights);
}
