// SPDX-License-Identifier: MIT
// The places of a profile, by definition and with 128-bit numbers.
#ifndef MICROTIN_TESTS_SUPPORT_REFERENCE_PROFILE_HPP
#define MICROTIN_TESTS_SUPPORT_REFERENCE_PROFILE_HPP

#include <algorithm>
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
  const Meeting begin = {{0, 1}, INT32_MIN}, end = {{1, 1}, INT32_MIN};
  if (places.empty() || places.front().way.part != 0) places.insert(places.begin(), begin);
  if (places.back().way < end.way) places.push_back(end);
  return places;
}

inline bool is_known(const std::vector<Stretch>& stretches, const Way& from, const Way& to) {
  return std::any_of(stretches.begin(), stretches.end(), [&](const Stretch& stretch) {
    return !(from < stretch.from) && !(stretch.to < to);
  });
}

}  // namespace reference
}  // namespace microtin::tests

#endif
