// SPDX-License-Identifier: MIT
#include "shared/predicates.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

#include "shared/pairs.hpp"
#include "tests/support/point_sets.hpp"
#include "tests/support/reference_delaunay.hpp"
#include "tests/support/slow.hpp"

namespace microtin::tests {
namespace {

// Whether both tests and the rule agree with the reference for the triangle in its
// counter-clockwise order, if it has one.
bool agrees(Point a, Point b, Point c, Point p) {
  const reference::Wide area = reference::area(a, b, c);
  if (orient2d(a, b, c) != area ||
      incircle(a, b, c, p) != reference::circle_determinant(a, b, c, p)) {
    return false;
  }
  if (area == 0) return true;
  if (area < 0) std::swap(b, c);
  if (p == a || p == b || p == c) return !conflicts_with_triangle(a, b, c, p);
  return conflicts_with_triangle(a, b, c, p) == reference::in_perturbed_circle(a, b, c, p);
}

bool ghost_agrees(Point u, Point w, Point p) {
  if (u == w) return true;
  if (p == u || p == w) return !conflicts_with_ghost(u, w, p);
  return conflicts_with_ghost(u, w, p) == reference::spoils_hull_edge(u, w, p);
}

// Random points near the sides and corners of the lattice, or anywhere.
Point extreme_point(Random& random) {
  const auto coordinate = [&random] {
    const uint32_t kind = random.below(4), offset = random.below(3);
    if (kind == 0) return offset;
    if (kind == 1) return 65535 - offset;
    if (kind == 2) return 32766 + offset;
    return random.below(65536);
  };
  const uint32_t x = coordinate();
  return point(x, coordinate());
}

// A point that p sees at coordinates of at most `most`, on the lattice.
Point near(Point p, int64_t most, Random& random) {
  const auto coordinate = [&](int64_t at) {
    const int64_t span = 2 * most + 1;
    const uint32_t kind = random.below(4);
    const int64_t offset = kind == 0   ? most
                           : kind == 1 ? -most
                                       : random.below(static_cast<uint32_t>(span)) - most;
    return std::min<int64_t>(std::max<int64_t>(at + offset, 0), kLatticeMax);
  };
  const int64_t x = coordinate(p.x);
  return point(x, coordinate(p.y));
}

// Whether the in-circle test in 32 bits is the other one where it may be asked, and is asked no
// farther than 128 steps.
bool near_agrees(Point a, Point b, Point c, Point p) {
  const Offset to_a = a - p, to_b = b - p, to_c = c - p;
  int64_t most = 0, least = 0;
  for (const int64_t v : {to_a.x, to_a.y, to_b.x, to_b.y, to_c.x, to_c.y}) {
    most = std::max(most, v);
    least = std::min(least, v);
  }
  const bool are_in_range = least >= -127 && most <= 128;
  if (are_near(to_a, to_b, to_c) != are_in_range) return false;
  return !are_in_range || near_incircle(to_a, to_b, to_c) == incircle(a, b, c, p);
}

#if defined(MICROTIN_PAIRS)

// Whether `window` tells the points that lie in it from others, and the in-circle test of pairs is
// that of points there.
bool pairs_agree(Point a, Point b, Point c, Point p) {
  const Point all[4] = {a, b, c, p};
  const auto begin = [](int64_t at) {
    return std::min<int64_t>(std::max<int64_t>(at - 16384, 0), 32768);
  };
  const int64_t x = begin(p.x), y = begin(p.y);
  const Pair window = window_around(pair_of(p));
  Pair seen[4];
  bool right = true, inside = true;
  for (int i = 0; i < 4; ++i) {
    seen[i] = microtin::difference(pair_of(all[i]), window);
    const bool in_window =
        all[i].x >= x && all[i].x < x + 32768 && all[i].y >= y && all[i].y < y + 32768;
    right = right && is_outside(seen[i]) == !in_window;
    inside = inside && in_window;
  }
  return right && (!inside || incircle(seen[0], seen[1], seen[2], seen[3]) == incircle(a, b, c, p));
}

#endif

}  // namespace

TEST_CASE("predicates: every quadruple of a small square, at each corner of the lattice") {
  constexpr uint32_t kSide = 4, kPlaces = kSide * kSide;
  std::size_t wrong = 0;
  for (const uint32_t corner : {0u, 1u, 2u, 3u}) {
    const auto place = [corner](uint32_t i) {
      return point((corner & 1u) * (65536 - kSide) + i / kSide,
                   (corner >> 1) * (65536 - kSide) + i % kSide);
    };
    for (uint32_t i = 0; i < kPlaces * kPlaces * kPlaces * kPlaces; ++i) {
      const Point a = place(i % 16), b = place(i / 16 % 16), c = place(i / 256 % 16);
      const Point p = place(i / 4096);
      wrong += !agrees(a, b, c, p);
      wrong += !ghost_agrees(a, b, p);
    }
  }
  CHECK(wrong == 0);
}

TEST_CASE("predicates: every quadruple of a coarse square as large as the lattice") {
  constexpr uint32_t kPlaces = 16;
  const auto place = [](uint32_t i) { return point(i / 4 * 21845, i % 4 * 21845); };
  std::size_t wrong = 0;
  for (uint32_t i = 0; i < kPlaces * kPlaces * kPlaces * kPlaces; ++i) {
    const Point a = place(i % 16), b = place(i / 16 % 16), c = place(i / 256 % 16);
    wrong += !agrees(a, b, c, place(i / 4096));
    wrong += !ghost_agrees(a, b, c);
  }
  CHECK(wrong == 0);
}

TEST_CASE("predicates: random and extreme points") {
  Random random(1);
  std::size_t wrong = 0;
  for (int i = 0; i < 2000000; ++i) {
    const Point a = extreme_point(random), b = extreme_point(random), c = extreme_point(random);
    wrong += !agrees(a, b, c, extreme_point(random));
    wrong += !ghost_agrees(a, b, c);
  }
  for (int i = 0; i < 1000000; ++i) {
    const auto any = [&random] { return point_in(random, 65536); };
    const Point a = any(), b = any(), c = any();
    wrong += !agrees(a, b, c, any());
  }
  CHECK(wrong == 0);
}

TEST_CASE("predicates: the largest determinant fits, one step more would not") {
  // S^4 / 2 for the even side S = 65534; the bound for 65535 is just below 2^63.
  const Point a = point(0, 0), b = point(65534, 0), c = point(32767, 32767), d = point(0, 65534);
  const reference::Wide side = 65534, largest = side * side * side * side / 2;
  CHECK(reference::circle_determinant(a, b, d, c) == largest);
  CHECK(incircle(a, b, d, c) == largest);
  CHECK(incircle(b, a, d, c) == -largest);
  const reference::Wide limit = std::numeric_limits<int64_t>::max();
  const reference::Wide whole = 65535;
  CHECK(whole * whole * whole * whole / 2 < limit);
  CHECK((whole + 1) * (whole + 1) * (whole + 1) * (whole + 1) / 2 > limit);
  // The largest that integer points of the whole lattice reach lies next to it.
  for (const int64_t x : {32767, 32768}) {
    for (const int64_t y : {32767, 32768}) {
      CHECK(agrees(point(0, 0), point(65535, 0), point(0, 65535), point(x, y)));
      CHECK(agrees(point(65535, 65535), point(65535, 0), point(0, 65535), point(x, y)));
    }
  }
}

TEST_CASE("predicates: cocircular points are decided, consistently from every triangle") {
  Random random(2);
  const Points circle = circle_points(5 * 5 * 13 * 17 * 29, random);
  REQUIRE(circle.size() > 40);
  std::size_t ties = 0, wrong = 0;
  for (int i = 0; i < 200000; ++i) {
    Points four;
    while (four.size() < 4) {
      const Point p = circle[random.below(static_cast<uint32_t>(circle.size()))];
      if (std::find(four.begin(), four.end(), p) == four.end()) four.push_back(p);
    }
    if (orient2d(four[0], four[1], four[2]) < 0) std::swap(four[1], four[2]);
    const Point a = four[0], b = four[1], c = four[2], p = four[3];
    ties += incircle(a, b, c, p) == 0;
    const bool conflict = conflicts_with_triangle(a, b, c, p);
    wrong += conflict != reference::in_perturbed_circle(a, b, c, p);
    wrong += conflict != conflicts_with_triangle(b, c, a, p);
    // One of the two diagonals of a convex quadrangle is chosen: p beyond the edge b -> c sees
    // (a, b, c) as a sees (p, c, b).
    if (orient2d(b, c, p) < 0) wrong += conflict != conflicts_with_triangle(p, c, b, a);
  }
  CHECK(ties == 200000);
  CHECK(wrong == 0);
}

TEST_CASE("predicates: exchanging two corners changes the sign") {
  Random random(3);
  std::size_t wrong = 0;
  for (int i = 0; i < 200000; ++i) {
    const Point a = extreme_point(random), b = extreme_point(random);
    const Point c = extreme_point(random), p = extreme_point(random);
    wrong += orient2d(a, b, c) != -orient2d(b, a, c) || orient2d(a, b, c) != orient2d(b, c, a);
    wrong += incircle(a, b, c, p) != -incircle(b, a, c, p);
    wrong += incircle(a, b, c, p) != incircle(b, c, a, p);
    wrong += incircle(a, b, c, p) != -incircle(p, b, c, a);
    wrong += incircle(a, b, c, p) != -incircle(a, p, c, b);
  }
  CHECK(wrong == 0);
}

TEST_CASE("predicates: the in-circle test in 32 bits is that in 64") {
  Random random(4);
  std::size_t wrong = 0;
  for (int i = 0; i < 1000000; ++i) {
    const Point p = extreme_point(random);
    const int64_t most = i % 3 == 0 ? 129 : 127;
    const Point a = near(p, most, random), b = near(p, most, random), c = near(p, most, random);
    wrong += !near_agrees(a, b, c, p);
    wrong += !near_agrees(a, b, extreme_point(random), p);
  }
  CHECK(wrong == 0);
  // The largest: a square of side 255 around p, and p at the middle of its lower side.
  const Point p = point(1000, 1000);
  for (const int64_t x : {-127, 128}) {
    for (const int64_t y : {-127, 128}) {
      CHECK(near_agrees(point(873, 873), point(1128, 873), point(1000 + x, 1128),
                        point(1000 + y, 1000)));
      CHECK(near_agrees(point(1128, 1128), point(1000 + x, 873), point(873, 1000 + y), p));
    }
  }
}

#if defined(MICROTIN_PAIRS)

TEST_CASE("predicates: the in-circle test of pairs is that of points" * kSlow) {
  Random random(5);
  std::size_t wrong = 0;
  for (int i = 0; i < 1000000; ++i) {
    const Point p = extreme_point(random);
    for (const int64_t most : {100, 16383, 16384, 32767, 32768}) {
      const Point a = near(p, most, random), b = near(p, most, random), c = near(p, most, random);
      wrong += !pairs_agree(a, b, c, p);
    }
    const Point a = extreme_point(random), b = extreme_point(random), c = extreme_point(random);
    wrong += !pairs_agree(a, b, c, p);
  }
  CHECK(wrong == 0);
  // Coordinates in each part of the lattice, seen from each.
  for (uint32_t at = 0; at <= kLatticeMax; at += 255) {
    for (uint32_t to = 0; to <= kLatticeMax; to += 85) {
      wrong += !pairs_agree(point(to, at), point(at, to), point(to, to), point(at, at));
    }
  }
  CHECK(wrong == 0);
}

#endif

}  // namespace microtin::tests
