// SPDX-License-Identifier: MIT
// Where the next point can lie, given that it is in conflict with an uncertified triangle: inside
// the triangle's circle, outside the circles of the certified triangles behind its sides.
// Everything here is an estimate that selects contexts and odds: it may be wrong, it must not
// overflow. All of it fits 32 bits.
#ifndef MICROTIN_SHARED_FREE_REGION_HPP
#define MICROTIN_SHARED_FREE_REGION_HPP

#include <stddef.h>

#include "shared/fixed_math.hpp"
#include "shared/pairs.hpp"
#include "shared/predicates.hpp"

namespace microtin {

// A place in grains, of which a lattice step has 2^shift: the shift is that which brings a
// triangle's corners just below 2^kCornerBits.
struct Spot {
  int32_t x;
  int32_t y;
};

constexpr int32_t kCornerBits = 11;

inline Spot operator-(Spot a, Spot b) {
  return Spot{a.x - b.x, a.y - b.y};
}

// Below 2^23 for two corners, and below 2^24 for a corner and a difference of two.
inline int32_t dot(Spot a, Spot b) {
  return a.x * b.x + a.y * b.y;
}

inline int32_t cross(Spot a, Spot b) {
  return a.x * b.y - a.y * b.x;
}

// v * 2^shift, rounded down; the result fits. |v| < 2^19, -26 <= shift <= 10.
#if UINTPTR_MAX > 0xFFFFFFFFu
inline int32_t shifted(FastInt v, int32_t shift) {
  constexpr int32_t kFiner = 32;  // by so much more, which leaves all below 2^61, and back
  return static_cast<int32_t>(v * (static_cast<FastInt>(1) << (shift + kFiner)) >> kFiner);
}
#else
inline int32_t shifted(FastInt v, int32_t shift) {
  return shift >= 0 ? v * (static_cast<FastInt>(1) << shift) : v >> -shift;
}
#endif

inline Spot shifted(Spot v, int32_t shift) {
  return Spot{shifted(v.x, shift), shifted(v.y, shift)};
}

// Has the highest bit of the longer coordinate.
inline uint32_t extent_of(Spot v) {
  return static_cast<uint32_t>(absolute(v.x)) | static_cast<uint32_t>(absolute(v.y));
}

// The bits of an extent but one, if it is not zero.
inline int32_t size_of(uint32_t extent) {
  return static_cast<int32_t>(highest_bit(extent));
}

// The circles through both ends of a side form a pencil, ordered by the cotangent of the angle
// under which the side is seen from the arc to its left. 12 fractional bits, capped.
typedef int32_t Cotangent;
constexpr uint32_t kCotangentBits = 12;
constexpr int32_t kOwnCap = 64, kBehindCap = 16;  // of a triangle's own circle, of that behind
constexpr int32_t kBeyondCap = 4;                 // of a circle that reaches beyond open sides

// A divisor brought below 2^12, so that dividends fit.
struct Divisor {
  int32_t h;
  uint32_t shift;
};

// h > 0.
inline Divisor divisor_of(int32_t h) {
  const uint32_t bits = highest_bit(static_cast<uint32_t>(h));
  const uint32_t shift = bits > 11 ? bits - 11 : 0;
  return Divisor{h >> shift, shift};
}

// q / h, at most `most` <= 64 in magnitude.
MICROTIN_FOLDED Cotangent cotangent(int32_t q, Divisor by, int32_t most) {
  const int32_t h = by.h;
  q = kept_within(q >> by.shift, -h * most, h * most);
  return q * (static_cast<int32_t>(1) << kCotangentBits) / h;
}

// The side from corner i to corner i + 1 of a triangle, and what is known behind it.
struct Side {
  bool certified;    // the triangle behind is final: its circle is empty
  bool ghost;        // certified, and outside the hull: nothing at all is behind
  Point apex;        // if not a ghost, the corner opposite to this side
  Cotangent behind;  // if not a ghost, the circle there, over this side
};

// All places but apexes are relative to corner v.
struct FreeRegion {
  bool opposite_certified;  // from c to a: all that counts of it
  Side chord;               // from a to v, which the walk came across: certified
  Side next;                // from v to c
  Point origin;             // v
  Spot corner[2];  // c, a, in lattice steps: v, c, a turn counter-clockwise and are not on a line
  int32_t shift;   // -5 .. 10
  Spot c, a;
  int32_t cc, aa, ca;  // dot products
  Log2 expected;       // log2 of the points that it should hold
  Divisor by_twice;    // twice the area
};

// Area, over the squared chord, of the segment that is seen under k >= 0 (8 fractional bits, at
// most 2^14): 12 fractional bits, at most 1592. It is about 1/6 (k + 0.734) / (k^2 + 0.734 k +
// 0.315), off by at most 1.25 %.
constexpr uint32_t minor_cap(uint32_t k) {
  return (k + 188u) * 174763u / (k * (k + 188u) + 20643u);
}

// Twice the area of a whole disc over the squared chord, pi / 2 (1 + k^2), with k <= 8 (8
// fractional bits): 8 fractional bits, at most 26130; with k <= 4 at most 6834.
constexpr uint32_t whole_disc(uint32_t k) {
  return (65536u + (k < 2048 ? k * k : 4194304u)) * 201u >> 15;
}

#if defined(MICROTIN_LARGE_TABLES)

// Both, for all cotangents up to the largest cap: 64 KB, of which few are met often.
struct CapTable {
  struct Entry {
    uint16_t minor, disc;
  } under[kOwnCap * 256 + 1];

  constexpr CapTable() : under() {
    uint32_t k = 0;
    for (Entry& entry : under) {
      entry.minor = static_cast<uint16_t>(minor_cap(k));
      entry.disc = static_cast<uint16_t>(whole_disc(k));
      ++k;
    }
  }
};

constexpr CapTable kCaps{};

inline uint32_t minor_cap_under(uint32_t k) {
  return kCaps.under[k].minor;
}

inline uint32_t whole_disc_under(uint32_t k) {
  return kCaps.under[k].disc;
}

#else

inline uint32_t minor_cap_under(uint32_t k) {
  return minor_cap(k);
}

inline uint32_t whole_disc_under(uint32_t k) {
  return whole_disc(k);
}

#endif

// Twice the area of the segment to the left of a chord of squared length `square` < 2^23, or 2^25
// if k <= 4: below 2^30. Up to a half disc (k <= 0) it is minor; beyond it is what the disc has
// left.
inline int32_t cap(uint32_t square, Cotangent fine) {
  const int32_t k = fine >> (kCotangentBits - 8);
  const uint32_t size = static_cast<uint32_t>(k < 0 ? -k : k);
  const int32_t minor = static_cast<int32_t>((square >> 4) * minor_cap_under(size) >> 7);
  if (k <= 0) return minor;
  return static_cast<int32_t>((square >> 8) * whole_disc_under(size)) - minor;
}

inline Spot spot_of(Offset v) {
  return Spot{static_cast<int32_t>(v.x), static_cast<int32_t>(v.y)};
}

// What an apex, behind a side from v to `end`, sees of it: a dot product, and twice the triangle's
// area. An apex farther than corners may be counts in coarser grains.
struct View {
  int32_t q, h;
};

// How much coarser: at most 16.
inline int32_t coarser_grains(const FreeRegion& region, uint32_t extent) {
  const int32_t beyond = size_of(extent) + region.shift - (kCornerBits - 1);
  return beyond > 0 ? beyond : 0;
}

#if defined(MICROTIN_PAIRS) && defined(__SSE2__)

static_assert(offsetof(FreeRegion, a) == offsetof(FreeRegion, c) + sizeof(Spot),
              "a vector holds both");

inline void see_corners(FreeRegion& region, Point v, Point c, Point a) {
  region.origin = v;
  _mm_storeu_si128(reinterpret_cast<__m128i*>(region.corner),
                   _mm_sub_epi32(both_of(c, a), both_of(v, v)));
}

inline int32_t bring_to_grains(FreeRegion& region) {
  const __m128i corners = _mm_loadu_si128(reinterpret_cast<const __m128i*>(region.corner));
  region.shift = kCornerBits - 1 - size_of(extent_of_both(corners));
  const __m128i both = all_shifted(corners, region.shift);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(&region.c), both);
  const __m128i products = products_of(both);
  region.cc = lane<0>(products);
  region.aa = lane<1>(products);
  region.ca = lane<2>(products);
  return lane<3>(products);
}

inline View view_from(const FreeRegion& region, Point apex, const Spot& end, int32_t turn) {
  const __m128i way = _mm_sub_epi32(place_of(apex), place_of(region.origin));
  const int32_t coarser = coarser_grains(region, extent_of_first(way));
  const __m128i ends = _mm_sra_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(&end)),
                                     _mm_cvtsi32_si128(coarser));
  const __m128i view = view_of(all_shifted(way, region.shift - coarser), ends, turn);
  return View{lane<0>(view), lane<2>(view)};
}

#else

inline void see_corners(FreeRegion& region, Point v, Point c, Point a) {
  region.origin = v;
  region.corner[0] = spot_of(c - v);
  region.corner[1] = spot_of(a - v);
}

inline int32_t bring_to_grains(FreeRegion& region) {
  const uint32_t extent = extent_of(region.corner[0]) | extent_of(region.corner[1]);
  region.shift = kCornerBits - 1 - size_of(extent);
  region.c = shifted(region.corner[0], region.shift);
  region.a = shifted(region.corner[1], region.shift);
  region.cc = dot(region.c, region.c);
  region.aa = dot(region.a, region.a);
  region.ca = dot(region.c, region.a);
  return cross(region.c, region.a);
}

inline View view_from(const FreeRegion& region, Point apex, Spot end, int32_t turn) {
  const Spot way = spot_of(apex - region.origin);
  const int32_t coarser = coarser_grains(region, extent_of(way));
  const Spot to_apex = shifted(way, region.shift - coarser);
  end = Spot{end.x >> coarser, end.y >> coarser};
  return View{dot(to_apex, end - to_apex), turn * cross(end, to_apex)};
}

#endif

// The circle over the side from v to `end`, seen from the apex of the triangle behind it; `turn` is
// 1 if that turns counter-clockwise from `end`, else -1.
inline Cotangent cotangent_behind(const FreeRegion& region, Point apex, const Spot& end,
                                  int32_t turn) {
  const View view = view_from(region, apex, end, turn);
  return cotangent(view.q, divisor_of(view.h > 1 ? view.h : 1), kBehindCap);
}

// Brings the corners to grains. Returns twice the area, > 0.
inline int32_t measure(FreeRegion& region) {
  const int32_t twice = bring_to_grains(region), kept = twice > 1 ? twice : 1;
  region.by_twice = divisor_of(kept);
  return kept;
}

// Twice what an open side lets the circle add; the opposite corner sees it under q / twice.
inline int32_t cap_beyond(const FreeRegion& region, int32_t square, int32_t q) {
  return cap(static_cast<uint32_t>(square), cotangent(q, region.by_twice, kBeyondCap));
}

// Twice what the circle behind a side from v to `end` takes away. Finds the circle.
inline int32_t cap_behind(const FreeRegion& region, Side& side, const Spot& end, int32_t square,
                          int32_t turn) {
  if (side.ghost) return 0;
  side.behind = cotangent_behind(region, side.apex, end, turn);
  return cap(static_cast<uint32_t>(square), side.behind);
}

// log2 of the free region's area in lattice units: the triangle and what its circle reaches beyond
// open sides, less what circles behind certified sides reach into it, but never less than a part
// of the triangle. Two segments below 2^30 and a triangle below 2^23 fit.
MICROTIN_OUT_OF_LINE inline Log2 free_area(FreeRegion& region) {
  const int32_t triangle = measure(region);
  const int32_t cc = region.cc, aa = region.aa, ca = region.ca;
  int32_t twice = triangle;
  twice += region.next.certified ? -cap_behind(region, region.next, region.c, cc, -1)
                                 : cap_beyond(region, cc, ca - aa);
  if (!region.opposite_certified) twice += cap_beyond(region, cc + aa - 2 * ca, -ca);
  twice -= cap_behind(region, region.chord, region.a, aa, 1);
  const int32_t least = (triangle >> 4) + 1;
  return rough_log2(static_cast<uint32_t>(twice > least ? twice : least)) -
         (2 * region.shift + 1) * kLog2One;
}

}  // namespace microtin

#endif
