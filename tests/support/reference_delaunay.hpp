// SPDX-License-Identifier: MIT
// What the canonical Delaunay triangulation is, by definition and with 128-bit numbers: slow, and
// independent of shared/predicates.hpp.
#ifndef MICROTIN_TESTS_SUPPORT_REFERENCE_DELAUNAY_HPP
#define MICROTIN_TESTS_SUPPORT_REFERENCE_DELAUNAY_HPP

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "shared/lattice.hpp"
#include "tests/support/layers.hpp"

namespace microtin::tests {
namespace reference {

__extension__ typedef __int128 Wide;

inline int sign(Wide value) {
  return (value > 0) - (value < 0);
}

// Twice the signed area.
inline Wide area(Point a, Point b, Point c) {
  return (Wide{b.x} - a.x) * (Wide{c.y} - a.y) - (Wide{b.y} - a.y) * (Wide{c.x} - a.x);
}

inline Wide lift(Point p) {
  return Wide{p.x} * p.x + Wide{p.y} * p.y;
}

// A point of the in-circle determinant and the coefficient that its lift has in it.
struct Term {
  Point place;
  Wide coefficient;
};

// The determinant is the area of (a, b, c) times the height of their lifted plane above the lifted
// p, so it is linear in the four lifts.
inline std::array<Term, 4> terms(Point a, Point b, Point c, Point p) {
  return {{{a, area(p, b, c)}, {b, area(a, p, c)}, {c, area(a, b, p)}, {p, -area(a, b, c)}}};
}

inline Wide circle_determinant(Point a, Point b, Point c, Point p) {
  Wide sum = 0;
  for (const Term& term : terms(a, b, c, p)) sum += term.coefficient * lift(term.place);
  return sum;
}

// Whether p lies in the circle of the counter-clockwise (a, b, c) once every lift is raised by an
// infinitesimal, infinitely larger for larger points: the largest point with a part in the
// determinant decides a tie.
inline bool in_perturbed_circle(Point a, Point b, Point c, Point p) {
  const int exact = sign(circle_determinant(a, b, c, p));
  if (exact != 0) return exact > 0;
  std::array<Term, 4> sorted = terms(a, b, c, p);
  std::sort(sorted.begin(), sorted.end(),
            [](const Term& s, const Term& t) { return t.place < s.place; });
  for (const Term& term : sorted) {
    if (term.coefficient != 0) return term.coefficient > 0;
  }
  return false;
}

// Whether p keeps u -> w from being a hull edge with the hull on its right.
inline bool spoils_hull_edge(Point u, Point w, Point p) {
  const int side = sign(area(u, w, p));
  if (side != 0) return side > 0;
  const bool inside_x = std::min(u.x, w.x) <= p.x && p.x <= std::max(u.x, w.x);
  const bool inside_y = std::min(u.y, w.y) <= p.y && p.y <= std::max(u.y, w.y);
  return inside_x && inside_y;
}

}  // namespace reference

// The triangles of a triangulation, however they were stored: each counter-clockwise from its
// smallest corner, in order; and its hull edges, the hull on their right, in order.
struct TriangleSet {
  using Triangle = std::array<Point, 3>;
  using Edge = std::array<Point, 2>;
  std::vector<Triangle> triangles;
  std::vector<Edge> hull;

  void add_triangle(Point a, Point b, Point c) {
    Triangle t = {a, b, c};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    triangles.push_back(t);
  }

  void add_hull_edge(Point u, Point w) { hull.push_back({u, w}); }

  void sort() {
    std::sort(triangles.begin(), triangles.end());
    std::sort(hull.begin(), hull.end());
  }
};

inline bool operator==(const TriangleSet& s, const TriangleSet& t) {
  return s.triangles == t.triangles && s.hull == t.hull;
}

// All triples of points with an empty circle and all pairs with an empty side. O(n^4).
inline TriangleSet reference_delaunay(const std::vector<Point>& points) {
  TriangleSet set;
  const auto none = [&points](const auto& conflicts) {
    return std::none_of(points.begin(), points.end(), conflicts);
  };
  for (const Point a : points) {
    for (const Point b : points) {
      if (a == b) continue;
      if (none([=](Point p) { return p != a && p != b && reference::spoils_hull_edge(a, b, p); })) {
        set.add_hull_edge(a, b);
      }
      for (const Point c : points) {
        if (!(a < b && a < c) || reference::area(a, b, c) <= 0) continue;
        if (none([=](Point p) {
              return p != a && p != b && p != c && reference::in_perturbed_circle(a, b, c, p);
            })) {
          set.add_triangle(a, b, c);
        }
      }
    }
  }
  set.sort();
  return set;
}

// Whether the sorted `set` is the canonical Delaunay triangulation. O(n^2). As many distinct
// triangles and hull edges as there must be together, none of them wrong, are all of them.
inline bool is_reference_delaunay(const std::vector<Point>& points, const TriangleSet& set) {
  if (set.triangles.size() + set.hull.size() != 2 * points.size() - 2) return false;
  if (std::adjacent_find(set.triangles.begin(), set.triangles.end()) != set.triangles.end() ||
      std::adjacent_find(set.hull.begin(), set.hull.end()) != set.hull.end()) {
    return false;
  }
  const auto in_points = [&points](Point a) {
    return std::find(points.begin(), points.end(), a) != points.end();
  };
  for (const auto& [a, b, c] : set.triangles) {
    if (!in_points(a) || !in_points(b) || !in_points(c)) return false;
    if (reference::area(a, b, c) <= 0) return false;
    for (const Point p : points) {
      if (p != a && p != b && p != c && reference::in_perturbed_circle(a, b, c, p)) return false;
    }
  }
  for (const auto& [u, w] : set.hull) {
    if (!in_points(u) || !in_points(w) || u == w) return false;
    for (const Point p : points) {
      if (p != u && p != w && reference::spoils_hull_edge(u, w, p)) return false;
    }
  }
  return true;
}

}  // namespace microtin::tests

#endif
