// SPDX-License-Identifier: MIT
// Exact orientation and in-circle tests on the 16-bit lattice, and the conflict rule that makes the
// Delaunay triangulation unique.
#ifndef MICROTIN_SHARED_PREDICATES_HPP
#define MICROTIN_SHARED_PREDICATES_HPP

#include "shared/lattice.hpp"

namespace microtin {

// Where a point lies as seen from another: each coordinate is within +-65535.
struct Offset {
  FastInt x;
  FastInt y;
};

inline Offset operator-(Point a, Point p) {
  return Offset{static_cast<FastInt>(a.x) - p.x, static_cast<FastInt>(a.y) - p.y};
}

inline Offset operator-(Offset a, Offset b) {
  return Offset{a.x - b.x, a.y - b.y};
}

// Twice the signed area of the origin, a, b: positive if they turn counter-clockwise. The products
// are below 2^32, so the difference is below 2^33; of points of the lattice it is within +-2^32.
inline int64_t cross(Offset a, Offset b) {
  return static_cast<int64_t>(a.x) * b.y - static_cast<int64_t>(a.y) * b.x;
}

inline int64_t dot(Offset a, Offset b) {
  return static_cast<int64_t>(a.x) * b.x + static_cast<int64_t>(a.y) * b.y;  // |result| < 2^33
}

// Twice the signed area of (a, b, c).
inline int64_t orient2d(Point a, Point b, Point c) {
  return cross(b - a, c - a);
}

// The product of two signed numbers modulo 2^64.
inline uint64_t wrapping_product(int64_t a, int64_t b) {
  return static_cast<uint64_t>(a) * static_cast<uint64_t>(b);
}

// The angle under which a point sees the chord from a to b: h is twice the triangle's area, q a dot
// product, q / h the cotangent. |h| <= 2^32, |q| < 2^33.
struct Angle {
  int64_t q;
  int64_t h;
};

inline Angle angle_between(Offset a, Offset b) {
  return Angle{dot(a, b), cross(a, b)};
}

inline Angle angle_at(Point p, Point a, Point b) {
  return angle_between(a - p, b - p);
}

// Positive if p lies inside the circle through the counter-clockwise a, b, c; zero if on it. c and
// p are given by the angles under which they see the chord from a to b.
//
// For four points in a square of side S the determinant is at most S^4 / 2 in magnitude
// (proofs.md, "The in-circle test"). S = 65535 gives 9.2228e18 < 2^63 = 9.2234e18, so
// the value computed modulo 2^64, read as a signed number, is exact.
static_assert(uint64_t{kLatticeMax} * kLatticeMax * kLatticeMax * kLatticeMax / 2 < INT64_MAX,
              "the largest determinant fits");

inline int64_t incircle(Angle c, Angle p) {
  return static_cast<int64_t>(wrapping_product(c.q, p.h) - wrapping_product(p.q, c.h));
}

inline int64_t incircle(Point a, Point b, Point c, Point p) {
  return incircle(angle_at(c, a, b), angle_at(p, a, b));
}

// The in-circle test of points that p sees at -127 .. 128 in both coordinates: all lie in a square
// of side 255, so 32 bits hold the determinant, and read it right modulo 2^32.
constexpr uint32_t kNear = 255;
static_assert(uint64_t{kNear} * kNear * kNear * kNear / 2 <= INT32_MAX, "a near determinant fits");

inline bool are_near(Offset a, Offset b, Offset c) {
  const auto above = [](FastInt v) { return static_cast<uint32_t>(v + 127); };
  const uint32_t bits = above(a.x) | above(a.y) | above(b.x) | above(b.y) | above(c.x) | above(c.y);
  return bits <= kNear;
}

inline int32_t near_dot(Offset a, Offset b) {
  return static_cast<int32_t>(a.x) * static_cast<int32_t>(b.x) +
         static_cast<int32_t>(a.y) * static_cast<int32_t>(b.y);
}

inline int32_t near_cross(Offset a, Offset b) {
  return static_cast<int32_t>(a.x) * static_cast<int32_t>(b.y) -
         static_cast<int32_t>(a.y) * static_cast<int32_t>(b.x);
}

// The product of two signed numbers modulo 2^32.
inline uint32_t wrapping_product32(int32_t a, int32_t b) {
  return static_cast<uint32_t>(a) * static_cast<uint32_t>(b);
}

inline int32_t near_incircle(Offset a, Offset b, Offset c) {
  const Offset to_a = a - c, to_b = b - c;
  return static_cast<int32_t>(wrapping_product32(near_dot(to_a, to_b), near_cross(a, b)) -
                              wrapping_product32(near_dot(a, b), near_cross(to_a, to_b)));
}

template <class Corner>
void turn(Corner& a, Corner& b, Corner& c) {
  const Corner first = a;
  a = b;
  b = c;
  c = first;
}

// Whether p conflicts with a counter-clockwise triangle on whose circle it lies, of which c is the
// largest corner and `angle` that under which p sees the other two. Ties are broken by lifting each
// point by an infinitesimal that grows with its lexicographic rank (Devillers and Teillaud,
// "Perturbations for Delaunay and weighted Delaunay 3D triangulations"): there is a conflict if p
// is smaller than c and, in its place, turns counter-clockwise. A corner never does: p conflicts
// with no triangle of its own.
inline bool conflicts_on_circle(Angle angle, Point c, Point p) {
  return p < c && angle.h > 0;
}

// Whether p conflicts with the counter-clockwise finite triangle (a, b, c). A corner does not.
inline bool conflicts_with_triangle(Point a, Point b, Point c, Point p) {
  const int64_t d = incircle(a, b, c, p);
  if (d != 0) return d > 0;
  while (c < a || c < b) turn(a, b, c);  // the largest last
  return conflicts_on_circle(angle_at(p, a, b), c, p);
}

// Whether p, which sees u and w under `angle`, conflicts with the ghost triangle (u, w, infinity),
// whose outside lies to the left of u -> w: strictly outside, or on the line strictly between u and
// w.
inline bool conflicts_with_ghost(Angle angle) {
  return angle.h > 0 || (angle.h == 0 && angle.q < 0);
}

inline bool conflicts_with_ghost(Point u, Point w, Point p) {
  return conflicts_with_ghost(angle_at(p, u, w));
}

}  // namespace microtin

#endif
