// SPDX-License-Identifier: MIT
// The highest on a course, asked for in calls of a few steps.
#ifndef MICROTIN_TESTS_SUPPORT_LIMITED_COURSE_HPP
#define MICROTIN_TESTS_SUPPORT_LIMITED_COURSE_HPP

#include "microtin/compact.h"
#include "tests/support/point_sets.hpp"

namespace microtin::tests {

struct Highest {
  microtin_answer answer;
  int32_t height;

  bool operator==(const Highest& other) const {
    return answer == other.answer && height == other.height;
  }
};

inline Highest highest_on(const microtin_mesh* mesh, const microtin_course& c) {
  Highest told = {MICROTIN_NOT_YET, 1};
  told.answer = microtin_highest(mesh, &c, &told.height);
  return told;
}

inline Highest highest_on(const microtin_compact* compact, const microtin_course& c) {
  Highest told = {MICROTIN_NOT_YET, 1};
  told.answer = microtin_compact_highest(compact, &c, &told.height);
  return told;
}

inline Highest limited_highest(const microtin_mesh* mesh, const microtin_course& c, uint32_t limit,
                               microtin_course_progress* progress) {
  Highest told = {MICROTIN_NOT_YET, 1};
  told.answer = microtin_highest_limited(mesh, &c, limit, progress, &told.height);
  return told;
}

inline Highest limited_highest(const microtin_compact* compact, const microtin_course& c,
                               uint32_t limit, microtin_course_progress* progress) {
  Highest told = {MICROTIN_NOT_YET, 1};
  told.answer = microtin_compact_highest_limited(compact, &c, limit, progress, &told.height);
  return told;
}

inline uint32_t triangles_of(const microtin_mesh* mesh) {
  return microtin_triangle_count(mesh);
}

inline uint32_t triangles_of(const microtin_compact* compact) {
  return microtin_compact_triangle_count(compact);
}

// In calls of 1 to `most` steps. NOT_YET if a call does more or says less than it may, if all
// together take more steps than promised, or if the last answer is not kept.
template <class Form>
Highest highest_in_pieces(const Form* form, const microtin_course& c, uint32_t most,
                          Random& random) {
  const Highest failed = {MICROTIN_NOT_YET, 1};
  microtin_course_progress progress = {};
  for (uint32_t steps = 0; steps < 3 * triangles_of(form) + most;) {
    const uint32_t limit = 1 + random.below(most), before = progress.next;
    const Highest told = limited_highest(form, c, limit, &progress);
    steps += limit;
    if (progress.next - before > limit) return failed;
    if (told.answer == MICROTIN_NOT_YET) {
      if (told.height != INT32_MIN) return failed;
    } else {
      return limited_highest(form, c, 1, &progress) == told ? told : failed;
    }
  }
  return failed;
}

}  // namespace microtin::tests

#endif
