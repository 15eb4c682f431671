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
constexpr Cotangent kCotangentCap = 23000;

static_assert(kCotangentCap > 89 * 256, "what is not capped is below the cap");
static_assert(int64_t{89} * 65536 * 256 < INT32_MAX, "a capped quotient's dividend fits");
static_assert(65536 + int64_t{kCotangentCap} * kCotangentCap < INT32_MAX, "a squared one fits");

// q / h, off by less than 2 / 256; |q| < 2^34, 0 < h < 2^34.
inline Cotangent cotangent(int64_t q, int64_t h) {
  // h is brought below 2^16, but not below 2^15: then |q| * 256 < 89 * 2^16 * 2^8 < 2^31.
  const uint32_t bits = highest_bit(static_cast<uint64_t>(h));
  const uint32_t shift = bits > 15 ? bits - 15 : 0;
  q >>= shift;
  const int32_t divisor = static_cast<int32_t>(h >> shift);
  if (q >= 89 * divisor) return kCotangentCap;
  if (q <= -89 * divisor) return -kCotangentCap;
  return static_cast<int32_t>(q) * 256 / divisor;
}

// The side from corner i to corner i + 1 of a triangle, and what is known behind it.
struct Side {
  bool certified;  // the triangle behind is final: its circle is empty
  bool ghost;      // ... and lies outside the hull: nothing at all is behind
  Offset apex;     // ... otherwise, the corner opposite to this side
  // The circles of the triangle itself and, if certified and no ghost, of the one behind.
  Cotangent own, behind;
};

constexpr int kChord = 2;  // the side the walk came from, from corner 2 (a) to corner 0 (v)

// All places are relative to corner 0.
struct FreeRegion {
  Point origin;
  Offset corner[3];  // v, c, a: counter-clockwise, never on a line
  Side side[3];
  int64_t twice_area;  // of the triangle
  int64_t swept_from;  // segment() of the circle behind the chord
};

// The circle through both ends of a chord and an apex to its right.
inline Cotangent cotangent_behind(Offset from, Offset to, Offset apex) {
  const Offset a = {from.x - apex.x, from.y - apex.y}, b = {to.x - apex.x, to.y - apex.y};
  return cotangent(-dot(a, b), cross(b, a));
}

// Areas carry 8 fractional bits; the largest disc has 2^58.
typedef int64_t Area;

// Area of the disc on whose circle a chord of squared length `length2` < 2^33 is seen under k.
inline Area disc_area(int64_t length2, Cotangent k) {
  // pi / 4 = 201 / 256; 1 + k^2 <= 2^22 with 8 fractional bits.
  return (length2 * ((65536 + k * k) >> 8) >> 8) * 201;
}

// Area, over length2, of the segment to the left of the chord: 17 fractional bits, below 2^32 .
// Up to a half disc (k <= 0) it comes from a table, beyond it is what the disc has left.
inline int64_t segment(Cotangent k) {
  const uint32_t size = static_cast<uint32_t>(k < 0 ? -k : k);
  uint32_t smaller;
  if (size < 2048) {
    const uint32_t i = size >> 5;
    const uint32_t low = table_segment(i), high = table_segment(i + 1);
    smaller = low - (((low - high) * (size & 31u)) >> 5);
  } else {
    smaller = 5592405u / size;  // 2 / (3 k), the first term of its series
  }
  if (k <= 0) return smaller;
  return (static_cast<int64_t>(65536 + k * k) * 3217 >> 11) - smaller;
}

// log2 of the free region's area in lattice units. Fills in the sides' cotangents.
inline Log2 free_area(FreeRegion& region) {
  const Offset* const corner = region.corner;
  const Offset edge[3] = {corner[1],
                          {corner[2].x - corner[1].x, corner[2].y - corner[1].y},
                          {-corner[2].x, -corner[2].y}};
  const int64_t h = cross(edge[0], edge[1]);
  // At the corner opposite to each side.
  const int64_t q[3] = {-dot(edge[1], edge[2]), -dot(edge[2], edge[0]), -dot(edge[0], edge[1])};
  region.twice_area = h;
  Area left = 0;
  Area disc = 0;
  for (int i = 2; i >= 0; --i) {
    Side& side = region.side[i];
    if (!side.certified) continue;
    const int64_t length2 = q[i == 2 ? 0 : i + 1] + q[i == 0 ? 2 : i - 1];
    side.own = cotangent(q[i], h);
    if (i == kChord) left = disc = disc_area(length2, side.own);
    int64_t lost = segment(-side.own);
    if (!side.ghost) {
      side.behind = cotangent_behind(corner[i], corner[i == 2 ? 0 : i + 1], side.apex);
      const int64_t behind = segment(side.behind);
      if (i == kChord) region.swept_from = behind;
      lost += behind;
    }
    left -= length2 * lost >> 9;
  }
  const Area least = (disc >> 8) + 1;
  return log2_of(static_cast<uint64_t>(left > least ? left : least)) - 8 * kLog2One;
}

// A circle by the power of places with respect to it, negative inside, in half lattice steps: at
// an offset (i, j) from some place it is value + i (x + i) + j (y + j).
struct Power {
  int64_t value;
  FastInt x;
  FastInt y;
};

// The circle through both ends of a chord, seen from `middle` (half steps from corner 0).
// Offsets are below 2^18: products 2^37, times a cotangent 2^52 >> 8; slopes below 2^27.
inline Power circle_over(Offset from, Offset to, Cotangent k, Offset middle) {
  const Offset a = {middle.x - 2 * from.x, middle.y - 2 * from.y};
  const Offset b = {middle.x - 2 * to.x, middle.y - 2 * to.y};
  const Offset chord = {a.x - b.x, a.y - b.y};
  Power power;
  power.value = dot(a, b) - ((k * cross(chord, a)) / 256);
  power.x = a.x + b.x + static_cast<FastInt>(static_cast<int64_t>(k) * chord.y / 256);
  power.y = a.y + b.y - static_cast<FastInt>(static_cast<int64_t>(k) * chord.x / 256);
  return power;
}

// The same seen from `to`.
inline Power moved(const Power& power, Offset to) {
  return Power{power.value + static_cast<int64_t>(to.x) * (power.x + to.x) +
                   static_cast<int64_t>(to.y) * (power.y + to.y),
               power.x + 2 * to.x, power.y + 2 * to.y};
}

// A box of lattice points, both ends included.
struct Box {
  FastInt x0, y0, x1, y1;
};

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

// A box that holds every lattice point of `bounds` that the free region can hold: the triangle
// itself and, beyond open sides, the circle's extremes. Circles whose cotangent over the chord is
// capped are not followed: the box is all of `bounds`.
inline Box enclosing_box(const FreeRegion& region, const Box& bounds) {
  const Point v = region.origin;
  Box box = {v.x, v.y, v.x, v.y};
  extend(box, v.x + region.corner[1].x, v.y + region.corner[1].y);
  extend(box, v.x + region.corner[2].x, v.y + region.corner[2].y);
  const Cotangent k = region.side[kChord].own;
  if (k == kCotangentCap || k == -kCotangentCap) return bounds;
  // Sixteenths of a step from v. The cotangent is off by less than 1/128, which moves the centre,
  // and changes the radius, by less than 1/256 of the chord. All below 2^28.
  const Offset a = region.corner[2];
  const FastInt cx = a.x * 8 + static_cast<FastInt>(static_cast<int64_t>(k) * a.y / 32);
  const FastInt cy = a.y * 8 - static_cast<FastInt>(static_cast<int64_t>(k) * a.x / 32);
  const FastInt margin = ((a.x < 0 ? -a.x : a.x) + (a.y < 0 ? -a.y : a.y)) / 8 + 2;
  const FastInt radius =
      static_cast<FastInt>(sqrt_above(static_cast<uint64_t>(dot(a, a) * (65536 + k * k)) >> 10)) +
      1 + margin;
  // The computed extremes are beyond the true ones by less than this.
  const FastInt slack = 2 * margin + 5 + (radius >> 13);
  bool west = false, east = false, south = false, north = false;
  for (int i = 0; i < 2; ++i) {
    if (region.side[i].certified) continue;
    const Offset from = region.corner[i], to = region.corner[i + 1];
    const Offset side = {to.x - from.x, to.y - from.y};
    // 2^18 * 2^28, twice.
    const int64_t centre = cross(side, Offset{cx - 16 * from.x, cy - 16 * from.y}) -
                           static_cast<int64_t>(slack) *
                               ((side.x < 0 ? -side.x : side.x) + (side.y < 0 ? -side.y : side.y));
    const int64_t along_x = static_cast<int64_t>(side.x) * radius;
    const int64_t along_y = static_cast<int64_t>(side.y) * radius;
    west = west || centre + along_y < 0;
    east = east || centre < along_y;
    south = south || centre < along_x;
    north = north || centre + along_x < 0;
  }
  if (west) box.x0 = v.x + static_cast<FastInt>((cx - radius + 15) >> 4);
  if (east) box.x1 = v.x + static_cast<FastInt>((cx + radius) >> 4);
  if (south) box.y0 = v.y + static_cast<FastInt>((cy - radius + 15) >> 4);
  if (north) box.y1 = v.y + static_cast<FastInt>((cy + radius) >> 4);
  if (box.x0 < bounds.x0) box.x0 = bounds.x0;
  if (box.y0 < bounds.y0) box.y0 = bounds.y0;
  if (box.x1 > bounds.x1) box.x1 = bounds.x1;
  if (box.y1 > bounds.y1) box.y1 = bounds.y1;
  return box;
}

}  // namespace microtin

#endif
