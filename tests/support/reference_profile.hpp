// SPDX-License-Identifier: MIT
// The places of a profile, by definition and with 128-bit numbers.
#ifndef MICROTIN_TESTS_SUPPORT_REFERENCE_PROFILE_HPP
#define MICROTIN_TESTS_SUPPORT_REFERENCE_PROFILE_HPP

#include <algorithm>
#include <string>
#include <vector>

#include "tests/support/reference_segment.hpp"

namespace microtin::tests {

inline bool same_crossing(const microtin_crossing& a, const microtin_crossing& b) {
  return a.along == b.along && a.height == b.height && a.result == b.result && a.before == b.before;
}

inline bool same_profile(const std::vector<microtin_crossing>& a,
                         const std::vector<microtin_crossing>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_crossing);
}

namespace reference {

// Every place where the segment meets an edge or a vertex that has a height, once, and its ends.
inline std::vector<Meeting> expected_places(const Surface& surface, const microtin_segment& c) {
  std::vector<Meeting> places = expect(surface, c).meetings;
  std::sort(places.begin(), places.end(),
            [](const Meeting& a, const Meeting& b) { return a.way < b.way; });
  const auto same_way = [](const Meeting& a, const Meeting& b) { return !(a.way < b.way); };
  places.erase(std::unique(places.begin(), places.end(), same_way), places.end());
  const Meeting begin = {{0, 1}, INT32_MIN, false}, end = {{1, 1}, INT32_MIN, false};
  if (places.empty() || places.front().way.part != 0) places.insert(places.begin(), begin);
  if (places.back().way < end.way) places.push_back(end);
  return places;
}

inline bool is_known(const std::vector<Stretch>& stretches, const Way& from, const Way& to) {
  return std::any_of(stretches.begin(), stretches.end(), [&](const Stretch& stretch) {
    return !(from < stretch.from) && !(stretch.to < to);
  });
}

// Whether a triangle or a vertex has a height at a place of the segment.
inline bool has_height(const std::vector<Meeting>& meetings, const Way& way, Wide height) {
  return std::any_of(meetings.begin(), meetings.end(), [&](const Meeting& m) {
    return !(m.way < way) && !(way < m.way) && m.height == height;
  });
}

// What is wrong with a profile of more than a single place; "" if nothing is. Where tiles disagree
// any of their heights is right.
inline std::string profile_fault(const Surface& surface, const microtin_segment& c,
                                 const std::vector<microtin_crossing>& profile) {
  const std::vector<Meeting> places = expected_places(surface, c),
                             meetings = expect(surface, c).meetings;
  const std::vector<Stretch> stretches = stretches_of(surface, c);
  if (profile.size() != places.size()) return "how many places there are";
  for (size_t i = 0; i < places.size(); ++i) {
    const Way& way = places[i].way;
    if (profile[i].along != (way.part << 30) / way.whole) return "a place";
    if ((profile[i].result == MICROTIN_QUERY_OK) != places[i].is_known)
      return "whether there is a height";
    if (places[i].is_known ? !has_height(meetings, way, profile[i].height)
                           : profile[i].height != INT32_MIN)
      return "a height";
    if (i == 0) continue;
    const bool is_known_before = is_known(stretches, places[i - 1].way, way);
    if ((profile[i].before == MICROTIN_QUERY_OK) != is_known_before) return "what is known before";
  }
  return "";
}

}  // namespace reference
}  // namespace microtin::tests

#endif
