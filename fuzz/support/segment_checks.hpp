// SPDX-License-Identifier: MIT
// The queries along a segment: in calls of any length as in one, and against all triangles.
#ifndef MICROTIN_FUZZ_SUPPORT_SEGMENT_CHECKS_HPP
#define MICROTIN_FUZZ_SUPPORT_SEGMENT_CHECKS_HPP

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "fuzz/support/expect.hpp"
#include "tests/support/limited_segment.hpp"
#include "tests/support/reference_clearance.hpp"
#include "tests/support/reference_profile.hpp"

namespace microtin::tests {

// What a form of a terrain returns for a path.
struct Walked {
  Extremes extremes;
  microtin_query_result result = MICROTIN_QUERY_STEP_LIMIT;  // of the clearance
  microtin_path_clearance clearance = {1, 1, 1};
  std::vector<microtin_crossing> profile;

  bool operator==(const Walked& other) const {
    return extremes == other.extremes && result == other.result &&
           clearance.least == other.clearance.least &&
           clearance.least_along == other.clearance.least_along &&
           clearance.first_along == other.clearance.first_along &&
           same_profile(profile, other.profile);
  }
};

template <class Form>
void walk_clearance(const Form* form, const microtin_path& path, uint32_t limit, Walked& walked) {
  microtin_segment_state state = {};
  for (uint32_t i = 0; walked.result == MICROTIN_QUERY_STEP_LIMIT; ++i) {
    EXPECT(i < 3 * triangles_of(form) + 10);
    walked.result = limited_clearance(form, path, &state, &walked.clearance, limit);
  }
}

// Up to the end; nothing, if a place cannot be found.
template <class Form>
void walk_profile(const Form* form, const microtin_segment& c, uint32_t limit, Walked& walked) {
  microtin_segment_state state = {};
  microtin_crossing crossing = {0, 0, 0, 0};
  for (uint32_t i = 0; crossing.along != MICROTIN_ALONG_END; ++i) {
    EXPECT(i < 5 * triangles_of(form) + 10);
    const microtin_query_result result = next_crossing(form, c, &state, &crossing, limit);
    if (result == MICROTIN_QUERY_STEP_LIMIT) continue;
    if (result != MICROTIN_QUERY_OK) return;
    walked.profile.push_back(crossing);
  }
}

// In calls of at most `limit` steps; 0: in one.
template <class Form>
Walked walk(const Form* form, const microtin_path& path, uint32_t limit) {
  Walked walked;
  Random random(limit);
  walked.extremes = limit == 0 ? extremes_on(form, path.segment)
                               : extremes_in_pieces(form, path.segment, limit, random);
  walk_clearance(form, path, limit, walked);
  walk_profile(form, path.segment, limit, walked);
  return walked;
}

inline bool is_place(const microtin_segment& c) {
  return c.x == c.x_end && c.y == c.y_end;
}

// A finding, unless there is no fault: says what is wrong, and for which path.
inline void expect_none(const std::string& fault, const microtin_path& path) {
  if (fault.empty()) return;
  const microtin_segment& c = path.segment;
  std::fprintf(stderr, "wrong: %s; from %lld %lld %ld to %lld %lld %ld, clearance %ld\n",
               fault.c_str(), static_cast<long long>(c.x), static_cast<long long>(c.y),
               static_cast<long>(path.z), static_cast<long long>(c.x_end),
               static_cast<long long>(c.y_end), static_cast<long>(path.z_end),
               static_cast<long>(path.clearance));
  std::abort();
}

// What is wrong with the extremes on a segment, if a terrain of one piece has them.
inline std::string extremes_fault(const reference::Expected& expected, const Extremes& extremes) {
  const microtin_segment_extremes& found = extremes.found;
  if ((extremes.answer == MICROTIN_QUERY_OK) != expected.is_known) return "what is known";
  if (found.highest != expected.highest()) return "the greatest height";
  if (found.lowest != expected.lowest()) return "the least height";
  if (found.highest_along != expected.first_along(found.highest)) return "the highest place";
  return found.lowest_along != expected.first_along(found.lowest) ? "the lowest place" : "";
}

// What is wrong with the extremes on a segment of a pack that is loaded. At a single place the
// height is that of any of its tiles.
inline std::string extremes_in_tiles_fault(const reference::Expected& expected,
                                           const Extremes& extremes, bool is_place) {
  const microtin_segment_extremes& found = extremes.found;
  if (extremes.answer != (expected.is_known ? MICROTIN_QUERY_OK : MICROTIN_QUERY_VOID))
    return "what is known";
  if (expected.meetings.empty()) {
    return found.highest == INT32_MIN && found.lowest == INT32_MAX ? "" : "a height of nothing";
  }
  if (!expected.has(found.highest, found.highest_along)) return "the highest place";
  if (!expected.has(found.lowest, found.lowest_along)) return "the lowest place";
  if (is_place) return "";
  if (found.highest != expected.highest()) return "the greatest height";
  return found.lowest != expected.lowest() ? "the least height" : "";
}

// Checks what a single terrain returns.
inline void check_walk(const reference::Surface& surface, const microtin_path& path,
                       const Walked& walked) {
  const microtin_segment& c = path.segment;
  EXPECT(walked.result == walked.extremes.answer);
  expect_none(extremes_fault(reference::expect(surface, c), walked.extremes), path);
  expect_none(reference::clearance_fault(surface, path, 0, walked.clearance), path);
  if (!is_place(c)) expect_none(reference::profile_fault(surface, c, walked.profile), path);
}

// Checks what a pack that is loaded returns. Along a border of tiles the least clearance may be at
// any of several places.
inline void check_walk_of_tiles(const reference::Surface& surface, const microtin_path& path,
                                const Walked& walked) {
  const microtin_segment& c = path.segment;
  EXPECT(walked.result == walked.extremes.answer);
  expect_none(extremes_in_tiles_fault(reference::expect(surface, c), walked.extremes, is_place(c)),
              path);
  if (is_place(c)) return;
  expect_none(
      reference::clearance_fault(surface, path, 0, walked.clearance, reference::LeastPlace::kAny),
      path);
  expect_none(reference::profile_fault(surface, c, walked.profile), path);
}

}  // namespace microtin::tests

#endif
