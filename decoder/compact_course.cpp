// SPDX-License-Identifier: MIT
// Courses and blocks on a compact terrain.
#include "decoder/ring_form.hpp"
#include "decoder/terrain_query.hpp"

using namespace microtin;

microtin_answer microtin_compact_highest(const microtin_compact* compact,
                                         const microtin_course* course, int32_t* height) {
  microtin_course_progress progress = {};
  return microtin_compact_highest_limited(compact, course, 0, &progress, height);
}

microtin_answer microtin_compact_highest_limited(const microtin_compact* compact,
                                                 const microtin_course* course, uint32_t step_limit,
                                                 microtin_course_progress* progress,
                                                 int32_t* height) {
  return highest_in_terrain(RingForm(compact), *course, step_limit, progress, height);
}

microtin_answer microtin_compact_fill(const microtin_compact* compact, const microtin_block* block,
                                      int16_t* heights) {
  return fill_from_terrain(RingForm(compact), compact->axis[2], *block, heights);
}
