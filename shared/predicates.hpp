// Exact orientation and in-circle tests on the 16-bit lattice, and the conflict rule that makes the
// Delaunay triangulation unique.
#ifndef MICROTIN_SHARED_PREDICATES_HPP
#define MICROTIN_SHARED_PREDICATES_HPP

#include "shared/lattice.hpp"

namespace microtin {

// Twice the signed area of (a, b, c): positive if they turn counter-clockwise.
// |products| < 2^32, so the difference is below 2^33 and the result within +-2^32.
inline int64_t orient2d(Point a, Point b, Point c) {
  const int32_t abx = static_cast<int32_t>(b.x) - a.x;
  const int32_t aby = static_cast<int32_t>(b.y) - a.y;
  const int32_t acx = static_cast<int32_t>(c.x) - a.x;
  const int32_t acy = static_cast<int32_t>(c.y) - a.y;
  return static_cast<int64_t>(abx) * acy - static_cast<int64_t>(aby) * acx;
}

inline int64_t squared_length(Point a, Point b) {
  const int32_t dx = static_cast<int32_t>(b.x) - a.x, dy = static_cast<int32_t>(b.y) - a.y;
  return static_cast<int64_t>(dx) * dx + static_cast<int64_t>(dy) * dy;  // < 2^33
}

// The product of two signed numbers modulo 2^64.
inline uint64_t wrapping_product(int64_t a, int64_t b) {
  return static_cast<uint64_t>(a) * static_cast<uint64_t>(b);
}

// Positive if p lies inside the circle through the counter-clockwise a, b, c; zero if on it.
//
// For four points in a square of side S the determinant is at most S^4 / 2 in magnitude
// (FORMAT.md, "Exactness", has the proof). S = 65535 gives 9.2228e18 < 2^63 = 9.2234e18, so the
// value computed modulo 2^64, read as a signed number, is exact.
// Written with a, b, p relative to c and the chord (a, b): h is twice an area, q a dot product,
// and incircle = q(c) h(p) - q(p) h(c). |h| <= 2^32, |q| < 2^33: each fits an int64.
inline int64_t incircle(Point a, Point b, Point c, Point p) {
  const int32_t cax = static_cast<int32_t>(a.x) - c.x, cay = static_cast<int32_t>(a.y) - c.y;
  const int32_t cbx = static_cast<int32_t>(b.x) - c.x, cby = static_cast<int32_t>(b.y) - c.y;
  const int32_t pax = static_cast<int32_t>(a.x) - p.x, pay = static_cast<int32_t>(a.y) - p.y;
  const int32_t pbx = static_cast<int32_t>(b.x) - p.x, pby = static_cast<int32_t>(b.y) - p.y;
  const int64_t h_c = static_cast<int64_t>(cax) * cby - static_cast<int64_t>(cay) * cbx;
  const int64_t q_c = static_cast<int64_t>(cax) * cbx + static_cast<int64_t>(cay) * cby;
  const int64_t h_p = static_cast<int64_t>(pax) * pby - static_cast<int64_t>(pay) * pbx;
  const int64_t q_p = static_cast<int64_t>(pax) * pbx + static_cast<int64_t>(pay) * pby;
  return static_cast<int64_t>(wrapping_product(q_c, h_p) - wrapping_product(q_p, h_c));
}

// Whether p, equal to none of them, conflicts with the counter-clockwise finite triangle (a, b, c).
// Ties are broken by lifting each point by an infinitesimal that grows with its lexicographic rank
// (Devillers and Teillaud, "Perturbations for Delaunay and weighted Delaunay 3D triangulations").
inline bool conflicts_with_triangle(Point a, Point b, Point c, Point p) {
  const int64_t d = incircle(a, b, c, p);
  if (d != 0) return d > 0;
  if (a < p && b < p && c < p) return false;
  if (b < a && c < a) return orient2d(p, b, c) > 0;
  if (a < b && c < b) return orient2d(a, p, c) > 0;
  return orient2d(a, b, p) > 0;
}

// Whether p, equal to neither, conflicts with the ghost triangle (u, w, infinity), whose outside
// lies to the left of u -> w: strictly outside, or on the line strictly between u and w.
inline bool conflicts_with_ghost(Point u, Point w, Point p) {
  const int64_t o = orient2d(u, w, p);
  if (o != 0) return o > 0;
  return u < w ? (u < p && p < w) : (w < p && p < u);
}

}  // namespace microtin

#endif
