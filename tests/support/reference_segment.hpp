// SPDX-License-Identifier: MIT
// What of a segment is known, and the heights where it meets edges, by definition and with 128-bit
// numbers.
#ifndef MICROTIN_TESTS_SUPPORT_REFERENCE_SEGMENT_HPP
#define MICROTIN_TESTS_SUPPORT_REFERENCE_SEGMENT_HPP

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "microtin/segment.h"
#include "tests/support/reference_heights.hpp"

namespace microtin::tests {
namespace reference {

// A part of the way along a segment, whole > 0.
struct Way {
  Wide part, whole;
};

inline bool operator<(const Way& a, const Way& b) {
  return a.part * b.whole < b.part * a.whole;
}

// The known triangles of all tiles that are there, in global steps.
struct Facet {
  std::array<std::array<int64_t, 3>, 3> v;
};

struct Surface {
  std::vector<Facet> facets;
  std::vector<std::array<int64_t, 3>> vertices;  // of voids too: they know their heights

  // A terrain that begins at (x, y).
  void add(const microtin_mesh* mesh, int64_t x, int64_t y) {
    for (const Corners& t : real_triangles(mesh)) {
      Facet facet;
      for (size_t i = 0; i < 3; ++i) {
        facet.v[i] = {x + t.v[i].x, y + t.v[i].y, t.v[i].z};
        vertices.push_back(facet.v[i]);
      }
      if (!t.is_void) facets.push_back(facet);
    }
  }
};

// 256 times twice the area of (a, b, p), where p has 8 fractional bits.
inline Wide area(const std::array<int64_t, 3>& a, const std::array<int64_t, 3>& b, int64_t x,
                 int64_t y) {
  return (Wide{b[0]} - a[0]) * (y - Wide{a[1]} * 256) -
         (Wide{b[1]} - a[1]) * (x - Wide{a[0]} * 256);
}

// A height where the segment meets an edge or a vertex, or ends.
struct Meeting {
  Way way;
  Wide height;
  bool is_known = true;  // false: an end without a height
};

struct Expected {
  bool is_known = false;
  std::vector<Meeting> meetings;  // in any tile

  Wide highest() const {
    Wide most = INT32_MIN;
    for (const Meeting& m : meetings) most = std::max(most, m.height);
    return most;
  }
  Wide lowest() const {
    Wide least = INT32_MAX;
    for (const Meeting& m : meetings) least = std::min(least, m.height);
    return least;
  }
  // The place, with 30 fractional bits and rounded down, of the first meeting with a height; 0 if
  // there is none.
  Wide first_along(Wide height) const {
    Way first = {2, 1};
    for (const Meeting& m : meetings) {
      if (m.height == height) first = std::min(first, m.way);
    }
    return first.part > first.whole ? 0 : (first.part << 30) / first.whole;
  }
  bool has(Wide height, Wide along) const {
    return std::any_of(meetings.begin(), meetings.end(), [&](const Meeting& m) {
      return m.height == height && (m.way.part << 30) / m.way.whole == along;
    });
  }
};

// The part of the segment in a closed triangle, and the heights at its ends.
struct Stretch {
  Way from = {0, 1}, to = {1, 1};
  bool is_empty = false;

  Stretch(const Facet& t, const microtin_segment& c) {
    for (size_t i = 0; i < 3; ++i) {
      const auto &a = t.v[i], &b = t.v[(i + 1) % 3];
      const Wide begin = area(a, b, c.x, c.y), end = area(a, b, c.x_end, c.y_end);
      if (begin < 0 && end < 0) is_empty = true;
      if (begin < 0 && end >= 0) from = std::max(from, Way{-begin, end - begin});
      if (begin >= 0 && end < 0) to = std::min(to, Way{begin, begin - end});
    }
    is_empty = is_empty || to < from;
  }
};

inline Wide height_at(const Facet& t, const microtin_segment& c, const Way& way) {
  Wide sum = 0, all = 0;
  for (size_t i = 0; i < 3; ++i) {
    const auto &a = t.v[(i + 1) % 3], &b = t.v[(i + 2) % 3];
    const Wide weight =
        area(a, b, c.x, c.y) * (way.whole - way.part) + area(a, b, c.x_end, c.y_end) * way.part;
    sum += weight * t.v[i][2];
    all += weight;
  }
  return rounded(sum * 65536, all);
}

inline std::vector<Stretch> stretches_of(const Surface& surface, const microtin_segment& c) {
  std::vector<Stretch> stretches;
  for (const Facet& t : surface.facets) {
    const Stretch stretch(t, c);
    if (!stretch.is_empty) stretches.push_back(stretch);
  }
  return stretches;
}

// Whether a segment of more than one place is covered.
inline bool cover(std::vector<Stretch> stretches) {
  std::sort(stretches.begin(), stretches.end(),
            [](const Stretch& a, const Stretch& b) { return a.from < b.from; });
  Way known = {0, 1};
  for (const Stretch& stretch : stretches) {
    if (!(known < stretch.from)) known = std::max(known, stretch.to);
  }
  return !stretches.empty() && stretches[0].from.part == 0 && !(known < Way{1, 1});
}

// By definition: closed triangles cover the segment, or do not.
inline Expected expect(const Surface& surface, const microtin_segment& c) {
  Expected expected;
  std::vector<Stretch> stretches;
  const bool is_place = c.x == c.x_end && c.y == c.y_end;
  for (const Facet& t : surface.facets) {
    const Stretch stretch(t, c);
    if (stretch.is_empty) continue;
    stretches.push_back(stretch);
    for (const Way& way : {stretch.from, stretch.to}) {
      expected.meetings.push_back({way, height_at(t, c, way)});
    }
  }
  for (const auto& v : surface.vertices) {
    const Wide x = Wide{v[0]} * 256 - c.x, y = Wide{v[1]} * 256 - c.y, dx = c.x_end - c.x,
               dy = c.y_end - c.y, along = x * dx + y * dy;
    if (x * dy != y * dx || along < 0 || along > dx * dx + dy * dy) continue;
    if (is_place && (x != 0 || y != 0)) continue;
    expected.meetings.push_back(
        {is_place ? Way{0, 1} : Way{along, dx * dx + dy * dy}, Wide{v[2]} * 65536});
    expected.is_known = is_place;
  }
  expected.is_known =
      expected.is_known || (is_place ? !stretches.empty() : cover(std::move(stretches)));
  return expected;
}

}  // namespace reference
}  // namespace microtin::tests

#endif
