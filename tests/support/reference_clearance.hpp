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

// Above a triangle, less `less`: all with 8 fractional bits.
inline Ratio clearance_at(const Facet& t, const microtin_path& path, const Way& way, Wide less) {
  Wide sum = 0, all = 0;
  for (size_t i = 0; i < 3; ++i) {
    const auto &a = t.v[(i + 1) % 3], &b = t.v[(i + 2) % 3];
    const microtin_segment& c = path.segment;
    const Wide weight =
        area(a, b, c.x, c.y) * (way.whole - way.part) + area(a, b, c.x_end, c.y_end) * way.part;
    sum += weight * t.v[i][2];
    all += weight;
  }
  const Wide height = Wide{path.z} * (way.whole - way.part) + Wide{path.z_end} * way.part;
  return {(height - less * way.whole) * all - 256 * sum * way.whole, all * way.whole};
}

inline Wide rounded_down(const Ratio& r) {
  return r.sum >= 0 ? r.sum / r.all : -((-r.sum + r.all - 1) / r.all);
}

// A part of the way with 30 fractional bits, kept within a stretch.
inline Way kept_within(const Stretch& stretch, Wide along) {
  const Way way = {along, Wide{1} << 30};
  return way < stretch.from ? stretch.from : stretch.to < way ? stretch.to : way;
}

// Vertices on the segment, and the ways to them.
template <class Use>
void for_vertices(const Surface& surface, const microtin_segment& c, const Use& use) {
  const Wide dx = c.x_end - c.x, dy = c.y_end - c.y, all = dx * dx + dy * dy;
  for (const auto& v : surface.vertices) {
    const Wide x = Wide{v[0]} * 256 - c.x, y = Wide{v[1]} * 256 - c.y, along = x * dx + y * dy;
    if (x * dy != y * dx || along < 0 || along > all || (all == 0 && (x != 0 || y != 0))) continue;
    use(all == 0 ? Way{0, 1} : Way{along, all}, Wide{v[2]} * 256);
    if (all == 0) use(Way{1, 1}, Wide{v[2]} * 256);
  }
}

// What is wrong with a clearance; "" if nothing is. The path is lower by `margin`.
inline std::string clearance_fault(const Surface& surface, const microtin_path& path, Wide margin,
                                   const microtin_path_clearance& found) {
  Wide least = INT32_MAX;
  Way first = {0, 1};
  bool is_low = false, is_early = false, is_late = false;
  const auto meet = [&](const Way& way, Wide clearance) {
    if (clearance > least || (clearance == least && !(way < first))) return;
    least = clearance;
    first = way;
  };
  const Wide here = found.first_along < 0 ? Wide{1} << 30 : Wide{found.first_along};
  for (const Facet& t : surface.facets) {
    const Stretch stretch(t, path.segment);
    if (stretch.is_empty) continue;
    for (const Way& way : {stretch.from, stretch.to}) {
      meet(way, rounded_down(clearance_at(t, path, way, margin)));
      is_low = is_low || clearance_at(t, path, way, margin + path.clearance).sum < 0;
    }
    // Clearance is linear: where it is too low at the place itself, it is so before, too, unless
    // the stretch begins there. Up to the next place it must be too low somewhere.
    const Way limit = {here, Wide{1} << 30}, next = {here + 1, Wide{1} << 30};
    for (const Way& way : {stretch.from, kept_within(stretch, here)}) {
      if (stretch.from < limit && clearance_at(t, path, way, margin + path.clearance).sum < 0) {
        is_late = true;
      }
    }
    for (const Way& way : {stretch.from, kept_within(stretch, here + 1)}) {
      if (!(next < way) && clearance_at(t, path, way, margin + path.clearance).sum < 0) {
        is_early = true;
      }
    }
  }
  for_vertices(surface, path.segment, [&](const Way& way, Wide height) {
    const Wide sum = Wide{path.z} * (way.whole - way.part) + Wide{path.z_end} * way.part -
                     (height + margin) * way.whole;
    meet(way, rounded_down(Ratio{sum, way.whole}));
    if (sum >= Wide{path.clearance} * way.whole) return;
    is_low = true;
    if (way.part << 30 < here * way.whole) is_late = true;
    if (way.part << 30 <= (here + 1) * way.whole) is_early = true;
  });
  if (found.least != least) return "the least clearance";
  if (least != INT32_MAX && found.least_along != (first.part << 30) / first.whole)
    return "its place";
  if (is_low != (found.first_along >= 0)) return "whether any is too low";
  if (is_late) return "the first place is too late";
  return is_low && !is_early ? "the first place is too early" : "";
}

}  // namespace reference
}  // namespace microtin::tests

#endif
