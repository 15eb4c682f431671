// SPDX-License-Identifier: MIT
// The height of a triangle's plane at a place inside it: one rounding, the same everywhere.
#ifndef MICROTIN_SHARED_INTERPOLATION_HPP
#define MICROTIN_SHARED_INTERPOLATION_HPP

#include "shared/fixed_math.hpp"
#include "shared/lattice.hpp"
#include "shared/predicates.hpp"

namespace microtin {

// A place with 8 fractional bits per coordinate: 0 .. 65535 * 256.
struct FinePoint {
  int32_t x;
  int32_t y;
};

template <class Number>
bool is_on_lattice(Number x, Number y) {
  const Number most = static_cast<Number>(kLatticeMax) * 256;
  return x >= 0 && x <= most && y >= 0 && y <= most;
}

inline FinePoint fine(Point p) {
  return FinePoint{static_cast<int32_t>(p.x) * 256, static_cast<int32_t>(p.y) * 256};
}

// 256 times twice the signed area of (a, b, p): positive if p lies to the left of a -> b.
// Each factor pair is below 2^16 * 2^24, so |result| < 2^41.
MICROTIN_IN_PLACE inline int64_t orient_fine(Point a, Point b, FinePoint p) {
  const int32_t abx = static_cast<int32_t>(b.x) - a.x;
  const int32_t aby = static_cast<int32_t>(b.y) - a.y;
  const FinePoint o = fine(a);
  return static_cast<int64_t>(abx) * (p.y - o.y) - static_cast<int64_t>(aby) * (p.x - o.x);
}

// Height, with 16 fractional bits and rounded to nearest (halves up), of the plane through the
// counter-clockwise a, b, c at p in the closed triangle. On an edge only the edge's ends count, so
// both sides agree.
//
// The barycentric weights are >= 0 and add up to w = 256 * twice the area <= 2^40. Relative to a.z
// the sum is at most 2^16 * w <= 2^56 in magnitude, so that with 2^16 * w added it is from 0 to
// 2^57. One more bit than is kept is divided out, to round.
MICROTIN_IN_PLACE inline int32_t height_in_triangle(Vertex a, Vertex b, Vertex c, FinePoint p) {
  const Point pa{a.x, a.y}, pb{b.x, b.y}, pc{c.x, c.y};
  const int64_t w = orient2d(pa, pb, pc) * 256;
  const int64_t weight_b = orient_fine(pc, pa, p);
  const int64_t weight_c = orient_fine(pa, pb, p);
  const int64_t sum =
      weight_b * (static_cast<int32_t>(b.z) - a.z) + weight_c * (static_cast<int32_t>(c.z) - a.z);
  const uint64_t raised = static_cast<uint64_t>(sum + w * 65536);
  const uint64_t rounded = (divide_finely(raised, static_cast<uint64_t>(w)) + 1) >> 1;
  return static_cast<int32_t>(static_cast<int64_t>(rounded) +
                              (static_cast<int64_t>(a.z) - 65536) * 65536);
}

}  // namespace microtin

#endif
