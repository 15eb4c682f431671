// SPDX-License-Identifier: MIT
// Queries along a segment of a mesh or of a compact terrain, in calls of a few steps.
#ifndef MICROTIN_TESTS_SUPPORT_LIMITED_SEGMENT_HPP
#define MICROTIN_TESTS_SUPPORT_LIMITED_SEGMENT_HPP

#include "microtin/compact.h"
#include "tests/support/point_sets.hpp"

namespace microtin::tests {

inline bool same(const microtin_segment_extremes& a, const microtin_segment_extremes& b) {
  return a.highest == b.highest && a.lowest == b.lowest && a.highest_along == b.highest_along &&
         a.lowest_along == b.lowest_along;
}

struct Extremes {
  microtin_query_result answer = MICROTIN_QUERY_STEP_LIMIT;
  microtin_segment_extremes found = {1, 1, 1, 1};

  bool operator==(const Extremes& other) const {
    return answer == other.answer && same(found, other.found);
  }
};

inline Extremes limited_extremes(const microtin_mesh* mesh, const microtin_segment& c,
                                 uint32_t limit, microtin_segment_state* state) {
  Extremes told;
  told.answer = microtin_mesh_segment_extremes(mesh, &c, state, &told.found, limit);
  return told;
}

inline Extremes limited_extremes(const microtin_compact* compact, const microtin_segment& c,
                                 uint32_t limit, microtin_segment_state* state) {
  Extremes told;
  told.answer = microtin_compact_segment_extremes(compact, &c, state, &told.found, limit);
  return told;
}

inline microtin_query_result limited_clearance(const microtin_mesh* mesh, const microtin_path& path,
                                               microtin_segment_state* state,
                                               microtin_path_clearance* clearance, uint32_t limit) {
  return microtin_mesh_path_clearance(mesh, &path, state, clearance, 0, limit);
}

inline microtin_query_result limited_clearance(const microtin_compact* compact,
                                               const microtin_path& path,
                                               microtin_segment_state* state,
                                               microtin_path_clearance* clearance, uint32_t limit) {
  return microtin_compact_path_clearance(compact, &path, state, clearance, 0, limit);
}

inline microtin_query_result next_crossing(const microtin_mesh* mesh, const microtin_segment& c,
                                           microtin_segment_state* state,
                                           microtin_crossing* crossing, uint32_t limit) {
  return microtin_mesh_profile_next(mesh, &c, state, crossing, limit);
}

inline microtin_query_result next_crossing(const microtin_compact* compact,
                                           const microtin_segment& c, microtin_segment_state* state,
                                           microtin_crossing* crossing, uint32_t limit) {
  return microtin_compact_profile_next(compact, &c, state, crossing, limit);
}

template <class Form>
Extremes extremes_on(const Form* form, const microtin_segment& c) {
  return limited_extremes(form, c, 0, nullptr);
}

inline uint32_t triangles_of(const microtin_mesh* mesh) {
  return microtin_mesh_triangle_count(mesh);
}

inline uint32_t triangles_of(const microtin_compact* compact) {
  return microtin_compact_triangle_count(compact);
}

// In calls of 1 to `most` steps. STEP_LIMIT if a call does not say where it stands, if all together
// take more steps than there are, or if the last answer is not kept.
template <class Form>
Extremes extremes_in_pieces(const Form* form, const microtin_segment& c, uint32_t most,
                            Random& random) {
  const Extremes failed, unknown{MICROTIN_QUERY_STEP_LIMIT, {INT32_MIN, INT32_MAX, 0, 0}};
  microtin_segment_state state = {};
  for (uint32_t steps = 0; steps < 3 * triangles_of(form) + most;) {
    const uint32_t limit = 1 + random.below(most);
    const Extremes told = limited_extremes(form, c, limit, &state);
    steps += limit;
    if (told.answer == MICROTIN_QUERY_STEP_LIMIT) {
      if (!(told == unknown)) return failed;
    } else {
      return limited_extremes(form, c, 1, &state) == told ? told : failed;
    }
  }
  return failed;
}

}  // namespace microtin::tests

#endif
