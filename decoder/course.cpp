// SPDX-License-Identifier: MIT
// Courses and blocks on a decoded mesh.
#include "decoder/mesh_form.hpp"
#include "decoder/terrain_query.hpp"

using namespace microtin;

microtin_answer microtin_highest(const microtin_mesh* mesh, const microtin_course* course,
                                 int32_t* height) {
  microtin_course_progress progress = {};
  return microtin_highest_limited(mesh, course, 0, &progress, height);
}

microtin_answer microtin_highest_limited(const microtin_mesh* mesh, const microtin_course* course,
                                         uint32_t step_limit, microtin_course_progress* progress,
                                         int32_t* height) {
  *height = INT32_MIN;
  const microtin_answer refusal = refusal_of(*mesh, 0);
  if (refusal != MICROTIN_HEIGHT) return refusal;
  return highest_in_terrain(MeshForm(mesh), *course, step_limit, progress, height);
}

microtin_answer microtin_fill(const microtin_mesh* mesh, const microtin_block* block,
                              int16_t* heights) {
  microtin_axis axis[3];
  microtin_placement(mesh, &axis[0], &axis[1], &axis[2]);
  return fill_from_terrain(MeshForm(mesh), axis[2], *block, heights);
}
