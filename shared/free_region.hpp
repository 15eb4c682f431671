// Where the next point can lie, given that it is in conflict with an uncertified triangle: inside
// the triangle's circle, outside the circles of the certified triangles behind its sides.
// Everything here is an estimate that selects contexts and odds, except enclosing_box, which must
// hold every legal point.
#ifndef MICROTIN_SHARED_FREE_REGION_HPP
#define MICROTIN_SHARED_FREE_REGION_HPP

#include "shared/fixed_math.hpp"
#include "shared/predicates.hpp"

namespace microtin {

// The side from corner i to corner i + 1 of a triangle, and what is known behind it.
struct Side {
  bool certified;  // the triangle behind is final: its circle is empty
  bool ghost;      // ... and lies outside the hull: nothing at all is behind
  Point apex;      // ... otherwise, the corner opposite to this side
};

constexpr int kChord = 2;  // the side the walk came from, from corner 2 (a) to corner 0 (v)

struct FreeRegion {
  Point corner[3];  // v, c, a: counter-clockwise, never on a line
  Side side[3];
};

// (a - p) . (b - p): negative if the angle at p is obtuse. |result| < 2^33.
inline int64_t dot_at(Point p, Point a, Point b) {
  const int32_t ax = static_cast<int32_t>(a.x) - p.x, ay = static_cast<int32_t>(a.y) - p.y;
  const int32_t bx = static_cast<int32_t>(b.x) - p.x, by = static_cast<int32_t>(b.y) - p.y;
  return static_cast<int64_t>(ax) * bx + static_cast<int64_t>(ay) * by;
}

// Areas carry 8 fractional bits and are capped, so that all sums stay far below 2^63.
typedef int64_t Area;
constexpr Area kAreaCap = static_cast<Area>(1) << 50;

// Area of the disc in which a chord of squared length `length2` < 2^33 is seen under the cotangent
// q / h, capped. 0 <= q < 2^34, 0 < h < 2^34.
inline Area disc_area(int64_t length2, int64_t q, int64_t h) {
  // pi / 4 * length2 * (1 + k^2); k = q / h with 8 fractional bits, at most 2^15.
  const int64_t k = quotient(q << 8, h);
  if (k >= 32768) return kAreaCap;
  const int64_t stretch = (65536 + k * k) >> 8;         // <= 2^22, 8 fractional bits
  const int64_t area = (length2 * stretch >> 8) * 201;  // pi / 4 = 201 / 256
  return area < kAreaCap ? area : kAreaCap;
}

// Area of the circular segment over such a chord in which it is seen under the cotangent q / h. Up
// to a half disc (q <= 0) it comes from a table, beyond it is what the disc has left.
inline Area segment_area(int64_t length2, int64_t q, int64_t h) {
  const int64_t size = q < 0 ? -q : q;
  // t = |q| / (|q| + h) in 13 bits: 5 choose the table entry, 8 interpolate.
  const uint32_t t = static_cast<uint32_t>(quotient(size << 13, size + h));
  const uint32_t i = t >> 8;
  uint32_t table = 0;  // 15 fractional bits, for a chord of length 2
  if (i < 32) {
    const uint32_t low = table_segment(i), high = table_segment(i + 1);
    table = low - (((low - high) * (t & 255u)) >> 8);
  }
  const Area smaller = (length2 * table) >> 9;
  return q <= 0 ? smaller : disc_area(length2, q, h) - smaller;
}

// Part of t's disc that side i's certified neighbour rules out: all beyond the side, and the
// neighbour's own segment on the near side.
inline Area ruled_out(const FreeRegion& region, int i, int64_t h) {
  const Point from = region.corner[i], to = region.corner[i == 2 ? 0 : i + 1];
  const int64_t length2 = squared_length(from, to);
  const int64_t q = dot_at(region.corner[i == 0 ? 2 : i - 1], from, to);
  const Area beyond = segment_area(length2, -q, h);
  const Side& side = region.side[i];
  if (side.ghost) return beyond;
  return beyond +
         segment_area(length2, -dot_at(side.apex, from, to), orient2d(to, from, side.apex));
}

// log2 of the free region's area in lattice units.
inline Log2 free_area(const FreeRegion& region) {
  const Point v = region.corner[0], c = region.corner[1], a = region.corner[2];
  const int64_t h = orient2d(v, c, a);
  const int64_t q = dot_at(c, v, a);
  const Area disc = disc_area(squared_length(v, a), q < 0 ? -q : q, h);
  Area left = disc;
  for (int i = 0; i < 3; ++i) {
    if (region.side[i].certified) left -= ruled_out(region, i, h);
  }
  const Area least = (disc >> 8) + 1;
  return log2_of(static_cast<uint64_t>(left > least ? left : least)) - 8 * kLog2One;
}

// A circle by the power of places with respect to it: negative inside. At an offset (i, j) from
// some origin it is constant + i (i + x) + j (j + y); all with 8 fractional bits.
struct Power {
  int64_t constant;
  int64_t x;
  int64_t y;
  int64_t steepness;  // length of the power's gradient on the circle: its diameter, within 7 %
};

constexpr int64_t kPowerSlopeCap = static_cast<int64_t>(1) << 40;

inline int64_t cap_slope(int64_t v) {
  return v > kPowerSlopeCap ? kPowerSlopeCap : v < -kPowerSlopeCap ? -kPowerSlopeCap : v;
}

inline int64_t magnitude(int64_t v) {
  return v < 0 ? -v : v;
}

// The circle through its origin whose gradient there is (x, y).
inline Power circle_with_gradient(int64_t x, int64_t y) {
  const int64_t ax = magnitude(x), ay = magnitude(y);
  const int64_t longer = ax > ay ? ax : ay, shorter = ax > ay ? ay : ax;
  return Power{0, x, y, longer + shorter * 3 / 8 + 1};
}

// The circle through p, q, r, counter-clockwise, relative to p. Numerators: 2^17 * 2^33 * 2 = 2^51,
// with 8 fractional bits 2^59; the divisor is an area of at least 1.
inline Power circle_through(Point p, Point q, Point r) {
  const int64_t sx = static_cast<int32_t>(q.x) - p.x, sy = static_cast<int32_t>(q.y) - p.y;
  const int64_t tx = static_cast<int32_t>(r.x) - p.x, ty = static_cast<int32_t>(r.y) - p.y;
  const int64_t h = sx * ty - sy * tx;
  const int64_t s2 = sx * sx + sy * sy, t2 = tx * tx + ty * ty;
  return circle_with_gradient(cap_slope(quotient((sy * t2 - ty * s2) * 256, h)),
                              cap_slope(quotient((tx * s2 - sx * t2) * 256, h)));
}

// |i|, |j| <= 2^16 and |x|, |y| <= 2^41 give terms below 2^58.
inline int64_t power_along(int64_t slope, int32_t i) {
  return (static_cast<int64_t>(i) * 256 + slope) * i;
}

inline Power moved_origin(const Power& power, int32_t i, int32_t j) {
  return Power{power.constant + power_along(power.x, i) + power_along(power.y, j),
               power.x + 512 * static_cast<int64_t>(i), power.y + 512 * static_cast<int64_t>(j),
               power.steepness};
}

// A box of lattice points, both ends included.
struct Box {
  int32_t x0, y0, x1, y1;
};

inline void extend(Box& box, Point p) {
  if (p.x < box.x0) box.x0 = p.x;
  if (p.x > box.x1) box.x1 = p.x;
  if (p.y < box.y0) box.y0 = p.y;
  if (p.y > box.y1) box.y1 = p.y;
}

// Whether (x, y) is beyond one of the region's open sides, or so close to it that errors of up to
// 3 units in each of its coordinates could hide it.
inline bool beyond_open_side(const FreeRegion& region, int64_t x, int64_t y) {
  for (int i = 0; i < 3; ++i) {
    if (region.side[i].certified) continue;
    const Point from = region.corner[i], to = region.corner[i == 2 ? 0 : i + 1];
    const int64_t dx = static_cast<int32_t>(to.x) - from.x,
                  dy = static_cast<int32_t>(to.y) - from.y;
    const int64_t side = dx * (y - from.y) - dy * (x - from.x);
    const int64_t slack = 4 * ((dx < 0 ? -dx : dx) + (dy < 0 ? -dy : dy));
    if (side < slack) return true;
  }
  return false;
}

// A box that holds every lattice point of `bounds` that the free region can hold: the triangle
// itself and, beyond open sides, the circle's extremes. Circles whose centre is
// further than 2^17 from v are not followed: the box is all of `bounds`.
inline Box enclosing_box(const FreeRegion& region, const Power& circle, const Box& bounds) {
  const Point v = region.corner[0];
  Box box = {v.x, v.y, v.x, v.y};
  extend(box, region.corner[1]);
  extend(box, region.corner[2]);
  const int64_t ox = -circle.x / 512, oy = -circle.y / 512;  // centre relative to v, within 1
  int64_t radius = 0;
  const int64_t limit = 131072;
  const bool huge = ox > limit || ox < -limit || oy > limit || oy < -limit;
  if (!huge) radius = sqrt_above(static_cast<uint64_t>(ox * ox + oy * oy)) + 2;
  if (huge || beyond_open_side(region, v.x + ox - radius, v.y + oy)) {
    box.x0 = static_cast<int32_t>(huge ? bounds.x0 : v.x + ox - radius);
  }
  if (huge || beyond_open_side(region, v.x + ox + radius, v.y + oy)) {
    box.x1 = static_cast<int32_t>(huge ? bounds.x1 : v.x + ox + radius);
  }
  if (huge || beyond_open_side(region, v.x + ox, v.y + oy - radius)) {
    box.y0 = static_cast<int32_t>(huge ? bounds.y0 : v.y + oy - radius);
  }
  if (huge || beyond_open_side(region, v.x + ox, v.y + oy + radius)) {
    box.y1 = static_cast<int32_t>(huge ? bounds.y1 : v.y + oy + radius);
  }
  if (box.x0 < bounds.x0) box.x0 = bounds.x0;
  if (box.y0 < bounds.y0) box.y0 = bounds.y0;
  if (box.x1 > bounds.x1) box.x1 = bounds.x1;
  if (box.y1 > bounds.y1) box.y1 = bounds.y1;
  return box;
}

}  // namespace microtin

#endif
