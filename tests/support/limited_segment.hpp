// SPDX-License-Identifier: MIT
// The highest on a segment, asked for in calls of a few steps.
#ifndef MICROTIN_TESTS_SUPPORT_LIMITED_SEGMENT_HPP
#define MICROTIN_TESTS_SUPPORT_LIMITED_SEGMENT_HPP

#include "microtin/compact.h"
#include "tests/support/point_sets.hpp"

namespace microtin::tests {

struct Highest {
  microtin_query_result answer;
  int32_t height;

  bool operator==(const Highest& other) const {
    return answer == other.answer && height == other.height;
  }
};

inline Highest highest_on(const microtin_mesh* mesh, const microtin_segment& c) {
  Highest told = {MICROTIN_QUERY_STEP_LIMIT, 1};
  told.answer = microtin_mesh_segment_max(mesh, &c, nullptr, &told.height, 0);
  return told;
}

inline Highest highest_on(const microtin_compact* compact, const microtin_segment& c) {
  Highest told = {MICROTIN_QUERY_STEP_LIMIT, 1};
  told.answer = microtin_compact_segment_max(compact, &c, nullptr, &told.height, 0);
  return told;
}

inline Highest limited_highest(const microtin_mesh* mesh, const microtin_segment& c, uint32_t limit,
                               microtin_segment_state* progress) {
  Highest told = {MICROTIN_QUERY_STEP_LIMIT, 1};
  told.answer = microtin_mesh_segment_max(mesh, &c, progress, &told.height, limit);
  return told;
}

inline Highest limited_highest(const microtin_compact* compact, const microtin_segment& c,
                               uint32_t limit, microtin_segment_state* progress) {
  Highest told = {MICROTIN_QUERY_STEP_LIMIT, 1};
  told.answer = microtin_compact_segment_max(compact, &c, progress, &told.height, limit);
  return told;
}

inline uint32_t triangles_of(const microtin_mesh* mesh) {
  return microtin_mesh_triangle_count(mesh);
}

inline uint32_t triangles_of(const microtin_compact* compact) {
  return microtin_compact_triangle_count(compact);
}

// In calls of 1 to `most` steps. STEP_LIMIT if a call does more or says less than it may, if all
// together take more steps than promised, or if the last answer is not kept.
template <class Form>
Highest highest_in_pieces(const Form* form, const microtin_segment& c, uint32_t most,
                          Random& random) {
  const Highest failed = {MICROTIN_QUERY_STEP_LIMIT, 1};
  microtin_segment_state progress = {};
  for (uint32_t steps = 0; steps < 3 * triangles_of(form) + most;) {
    const uint32_t limit = 1 + random.below(most), before = progress.next;
    const Highest told = limited_highest(form, c, limit, &progress);
    steps += limit;
    if (progress.next - before > limit) return failed;
    if (told.answer == MICROTIN_QUERY_STEP_LIMIT) {
      if (told.height != INT32_MIN) return failed;
    } else {
      return limited_highest(form, c, 1, &progress) == told ? told : failed;
    }
  }
  return failed;
}

}  // namespace microtin::tests

#endif
