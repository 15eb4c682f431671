// SPDX-License-Identifier: MIT
// The clearance of a path above a surface, by definition and with 128-bit numbers.
#ifndef MICROTIN_TESTS_SUPPORT_REFERENCE_CLEARANCE_HPP
#define MICROTIN_TESTS_SUPPORT_REFERENCE_CLEARANCE_HPP

#include <string>

#include "tests/support/reference_segment.hpp"

namespace microtin::tests {
namespace reference {

// A fraction; all > 0.
struct Ratio {
  Wide sum, all;
};

// Above a triangle, less `less`: all with 8 fractional bits. The weights of the corners have one
// sum, so that what is divided by stays below 2^84, and the sum below 2^112.
inline Ratio clearance_at(const Facet& t, const microtin_path& path, const Way& way, Wide less) {
  const microtin_segment& c = path.segment;
  Wide sum = 0, all = 0;
  for (size_t i = 0; i < 3; ++i) {
    const auto &a = t.v[(i + 1) % 3], &b = t.v[(i + 2) % 3];
    const Wide begin = area(a, b, c.x, c.y), end = area(a, b, c.x_end, c.y_end);
    sum += (begin * (way.whole - way.part) + end * way.part) * t.v[i][2];
    all += begin;
  }
  const Wide height = Wide{path.z} * (way.whole - way.part) + Wide{path.z_end} * way.part;
  return {(height - less * way.whole) * all - 256 * sum, all * way.whole};
}

inline Wide rounded_down(const Ratio& r) {
  return r.sum >= 0 ? r.sum / r.all : -((-r.sum + r.all - 1) / r.all);
}

// A part of the way with 30 fractional bits, kept between two others.
inline Way kept_within(const Way& from, const Way& to, Wide along) {
  const Way way = {along, Wide{1} << 30};
  return way < from ? from : to < way ? to : way;
}

// Calls use(from, to, clearance) for all parts of a path, some of them single places, above a
// triangle or a vertex. There clearance(way, less) is how far the path is above it, less `less`.
template <class Use>
void for_parts(const Surface& surface, const microtin_path& path, const Use& use) {
  const microtin_segment& c = path.segment;
  for (const Facet& t : surface.facets) {
    const Stretch stretch(t, c);
    if (stretch.is_empty) continue;
    use(stretch.from, stretch.to,
        [&](const Way& way, Wide less) { return clearance_at(t, path, way, less); });
  }
  const Wide dx = c.x_end - c.x, dy = c.y_end - c.y, all = dx * dx + dy * dy;
  for (const auto& v : surface.vertices) {
    const Wide x = Wide{v[0]} * 256 - c.x, y = Wide{v[1]} * 256 - c.y, along = x * dx + y * dy;
    if (x * dy != y * dx || along < 0 || along > all || (all == 0 && (x != 0 || y != 0))) continue;
    use(all == 0 ? Way{0, 1} : Way{along, all}, all == 0 ? Way{1, 1} : Way{along, all},
        [&](const Way& way, Wide less) {
          return Ratio{Wide{path.z} * (way.whole - way.part) + Wide{path.z_end} * way.part -
                           (Wide{v[2]} * 256 + less) * way.whole,
                       way.whole};
        });
  }
}

// Which of several places with the least clearance is right: the first, or any of them.
enum class LeastPlace { kFirst, kAny };

// What is wrong with a clearance; "" if nothing is. The path is lower by `margin`.
inline std::string clearance_fault(const Surface& surface, const microtin_path& path, Wide margin,
                                   const microtin_path_clearance& found,
                                   LeastPlace place = LeastPlace::kFirst) {
  Wide least = INT32_MAX;
  Way first = {0, 1};
  bool is_low = false, is_early = false, is_late = false, is_there = false;
  const Wide here = found.first_along < 0 ? Wide{1} << 30 : Wide{found.first_along};
  const Way limit = {here, Wide{1} << 30}, next = {here + 1, Wide{1} << 30};
  for_parts(surface, path, [&](const Way& from, const Way& to, const auto& clearance) {
    const auto is_low_at = [&](const Way& way) {
      return clearance(way, margin + path.clearance).sum < 0;
    };
    for (const Way& way : {from, to}) {
      const Wide above = rounded_down(clearance(way, margin));
      const bool is_here = (way.part << 30) / way.whole == found.least_along;
      is_there = is_there || (above == found.least && is_here);
      is_low = is_low || is_low_at(way);
      if (above > least || (above == least && !(way < first))) continue;
      least = above;
      first = way;
    }
    // Clearance is linear: where it is too low at the place itself, it is so before, too, unless
    // the part begins there. Up to the next place it must be too low somewhere.
    for (const Way& way : {from, kept_within(from, to, here)}) {
      is_late = is_late || (from < limit && is_low_at(way));
    }
    for (const Way& way : {from, kept_within(from, to, here + 1)}) {
      is_early = is_early || (!(next < way) && is_low_at(way));
    }
  });
  if (found.least != least) return "the least clearance";
  const bool is_first = found.least_along == (first.part << 30) / first.whole;
  if (least != INT32_MAX && !(place == LeastPlace::kFirst ? is_first : is_there))
    return "its place";
  if (is_low != (found.first_along >= 0)) return "whether any is too low";
  if (is_late) return "the first place is too late";
  return is_low && !is_early ? "the first place is too early" : "";
}

}  // namespace reference
}  // namespace microtin::tests

#endif
