// SPDX-License-Identifier: MIT
// Where the next point can lie, given that it is in conflict with an uncertified triangle: inside
// the triangle's circle, outside the circles of the certified triangles behind its sides.
// Everything here is an estimate that selects contexts and odds, except enclosing_box, which must
// hold every legal point.
#ifndef MICROTIN_SHARED_FREE_REGION_HPP
#define MICROTIN_SHARED_FREE_REGION_HPP

#include "shared/fixed_math.hpp"
#include "shared/predicates.hpp"

namespace microtin {

// The circles through both ends of a side form a pencil, ordered by the cotangent of the angle
// under which the side is seen from the arc to its left. 8 fractional bits, capped.
typedef int32_t Cotangent;
constexpr Cotangent kCotangentCap = 89 * 256;

static_assert(int64_t{kCotangentCap} * 65536 < INT32_MAX, "a quotient's dividend fits");
static_assert(65536 + int64_t{kCotangentCap} * kCotangentCap < INT32_MAX, "a squared one fits");

// q / h, off by less than 2 / 256; |q| < 2^34, 0 < h < 2^34.
inline Cotangent cotangent(int64_t q, int64_t h) {
  // h is brought below 2^16, but not below 2^15: then |q| * 256 <= 89 * 2^16 * 2^8 < 2^31.
  const uint32_t bits = highest_bit(static_cast<uint64_t>(h));
  const uint32_t shift = bits > 15 ? bits - 15 : 0;
  const int32_t divisor = static_cast<int32_t>(scaled(h, 1, shift));
  return kept_within(scaled(q, 1, shift), 89 * divisor) * 256 / divisor;
}

// The side from corner i to corner i + 1 of a triangle, and what is known behind it.
struct Side {
  bool certified;  // the triangle behind is final: its circle is empty
  bool ghost;      // ... and lies outside the hull: nothing at all is behind
  Offset apex;     // ... otherwise, the corner opposite to this side
  // The circles of the triangle itself and of the one behind; of a ghost's, one so large that its
  // segment is next to nothing.
  Cotangent own, behind;
};

constexpr int kChord = 2;  // the side the walk came from, from corner 2 (a) to corner 0 (v)

// All places are relative to corner 0.
struct FreeRegion {
  Point origin;
  Offset corner[4];  // v, c, a, counter-clockwise, never on a line; v
  Side side[3];
};

// Of the angle under which `from` sees the side from a to b, which is to its right.
inline Cotangent cotangent_at(const Offset& from, const Offset& a, const Offset& b) {
  const Offset to_a = a - from, to_b = b - from;
  return cotangent(dot(to_a, to_b), cross(to_a, to_b));
}

// Areas carry 8 fractional bits; the largest disc has 2^58.
typedef int64_t Area;

// Area of the disc on whose circle a chord of squared length `length2` < 2^33 is seen under k.
inline Area disc_area(int64_t length2, Cotangent k) {
  // pi / 4 = 201 / 256; 1 + k^2 <= 2^22 with 8 fractional bits.
  return scaled(length2, (65536 + k * k) >> 8, 8) * 201;
}

// Area, over length2, of the segment to the left of the chord: 17 fractional bits, below 2^30. Up
// to a half disc (k <= 0) it is about 2/3 / (k + 0.315 / (k + 0.734)), off by at most 1.25 %;
// beyond it is what the disc has left.
inline int32_t segment(Cotangent k) {
  const uint32_t size = static_cast<uint32_t>(k < 0 ? -k : k);
  const int32_t smaller = static_cast<int32_t>(89478480u / (16u * size + 330400u / (size + 188u)));
  if (k <= 0) return smaller;
  return static_cast<int32_t>(static_cast<int64_t>(65536 + k * k) * 3217 >> 11) - smaller;
}

// log2 of the free region's area in lattice units. Fills in the sides' cotangents.
inline Log2 free_area(FreeRegion& region) {
  Area lost = 0;
  for (int i = 0; i < 3; ++i) {
    Side& side = region.side[i];
    if (!side.certified) continue;
    const Offset& from = region.corner[i];
    const Offset& to = region.corner[i + 1];
    side.own = cotangent_at(region.corner[i == 0 ? 2 : i - 1], from, to);
    int32_t segments = segment(-side.own);
    if (side.ghost) {
      side.behind = (side.own < 0 ? side.own : 0) - 8 * 256;
    } else {
      side.behind = -cotangent_at(side.apex, to, from);
      segments += segment(side.behind);
    }
    lost += scaled(dot(to - from, to - from), segments, 9);
  }
  const Offset chord = region.corner[kChord];
  const Area disc = disc_area(dot(chord, chord), region.side[kChord].own);
  const Area left = disc - lost, least = (disc >> 8) + 1;
  return log2_of(static_cast<uint64_t>(left > least ? left : least)) - 8 * kLog2One;
}

// A circle by the power of places with respect to it, negative inside, in half lattice steps: at
// an offset (i, j) from some place it is value + i (x / 16 + i) + j (y / 16 + j).
struct Power {
  int64_t value;
  FastInt x;
  FastInt y;
};

// The circle through both ends of a chord, seen from `middle` (half steps from corner 0).
// Offsets are below 2^18: products 2^37, times a cotangent 2^52 >> 8; slopes below 2^29.
inline Power circle_over(Offset from, Offset to, Cotangent k, Offset middle) {
  const Offset a = {middle.x - 2 * from.x, middle.y - 2 * from.y};
  const Offset b = {middle.x - 2 * to.x, middle.y - 2 * to.y};
  const Offset chord = {a.x - b.x, a.y - b.y};
  Power power;
  power.value = dot(a, b) - scaled(cross(chord, a), k, 8);
  power.x = 16 * (a.x + b.x) + static_cast<FastInt>(static_cast<int64_t>(k) * chord.y >> 4);
  power.y = 16 * (a.y + b.y) - static_cast<FastInt>(static_cast<int64_t>(k) * chord.x >> 4);
  return power;
}

// A box of lattice points, both ends included.
struct Box {
  FastInt x0, y0, x1, y1;
};

// Half steps.
inline Offset middle_of(const Box& box) {
  return Offset{box.x0 + box.x1, box.y0 + box.y1};
}

// log2 of its longer side, rounded down.
inline uint32_t size_of(const Box& box) {
  return highest_bit(static_cast<uint32_t>((box.x1 - box.x0) | (box.y1 - box.y0) | 1));
}

inline void extend(Box& box, FastInt x, FastInt y) {
  if (x < box.x0) box.x0 = x;
  if (x > box.x1) box.x1 = x;
  if (y < box.y0) box.y0 = y;
  if (y > box.y1) box.y1 = y;
}

// Cuts the box off where it is beyond another.
inline void cut(Box& box, const Box& bounds) {
  if (box.x0 < bounds.x0) box.x0 = bounds.x0;
  if (box.y0 < bounds.y0) box.y0 = bounds.y0;
  if (box.x1 > bounds.x1) box.x1 = bounds.x1;
  if (box.y1 > bounds.y1) box.y1 = bounds.y1;
}

// Extends a box to those of a circle's extremes that are less than `slack` on the near side of an
// open side, or beyond it; all in sixteenths of a step. Products are below 2^18 * 2^28, twice.
inline void extend_beyond(Box& box, Offset from, Offset side, Offset centre, FastInt radius,
                          FastInt slack) {
  const int64_t near = cross(side, centre - Offset{16 * from.x, 16 * from.y}) -
                       static_cast<int64_t>(slack) * (absolute(side.x) + absolute(side.y));
  for (int i = 0; i < 2; ++i) {  // west and south, east and north; rounded inwards
    const FastInt reach = i == 0 ? -radius : radius, round = i == 0 ? 15 : 0;
    const Offset rounded = {centre.x + round, centre.y + round};
    if (near < static_cast<int64_t>(side.y) * reach) {
      extend(box, (rounded.x + reach) >> 4, rounded.y >> 4);
    }
    if (near + static_cast<int64_t>(side.x) * reach < 0) {
      extend(box, rounded.x >> 4, (rounded.y + reach) >> 4);
    }
  }
}

// Cuts off a box what the free region cannot hold: it holds the triangle itself and, beyond open
// sides, the circle's extremes. Circles whose cotangent over the chord is capped are not followed.
inline void enclose(const FreeRegion& region, Box& bounds) {
  const Cotangent k = region.side[kChord].own;
  if (absolute(k) == kCotangentCap) return;
  // Sixteenths of a step from v. The cotangent is off by less than 1/128, which moves the centre,
  // and changes the radius, by less than 1/256 of the chord. All below 2^28.
  const Offset c = region.corner[1], a = region.corner[2];
  const Offset centre = {a.x * 8 + static_cast<FastInt>(static_cast<int64_t>(k) * a.y >> 5),
                         a.y * 8 - static_cast<FastInt>(static_cast<int64_t>(k) * a.x >> 5)};
  const FastInt margin = (absolute(a.x) + absolute(a.y)) / 8 + 2;
  const int64_t square = scaled(dot(a, a), 65536 + k * k, 10);
  const FastInt radius = static_cast<FastInt>(sqrt_above(static_cast<uint64_t>(square))) + margin;
  // The computed extremes are beyond the true ones by less than this.
  const FastInt slack = 2 * margin + 5 + (radius >> 7);
  Box box = {a.x, a.y, a.x, a.y};
  extend(box, 0, 0);
  extend(box, c.x, c.y);
  for (int i = 0; i < 2; ++i) {
    const Offset from = region.corner[i], side = region.corner[i + 1] - from;
    if (!region.side[i].certified) extend_beyond(box, from, side, centre, radius, slack);
  }
  cut(bounds, box);
}

}  // namespace microtin

#endif
