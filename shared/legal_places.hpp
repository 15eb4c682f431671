// SPDX-License-Identifier: MIT
// The places where the next point is likely legal, column by column: between the ends that the
// triangle's circle, the circles behind its certified sides and the lattice leave.
//
// They are seen from corner v, and turned by quarters so that the chord comes from the west: its
// start a lies at x < 0, |y| <= -x. So the triangle is north of the chord, and a column's rows are
// met from the chord on.
#ifndef MICROTIN_SHARED_LEGAL_PLACES_HPP
#define MICROTIN_SHARED_LEGAL_PLACES_HPP

#include "shared/format.hpp"
#include "shared/free_region.hpp"
#include "shared/parity_coding.hpp"

namespace microtin {

// A circle through v, in grains: at x it reaches from y - r to y + r with r^2 = x (x2 - x) + yy.
struct Circle {
  int32_t x2;  // twice the centre's x
  int32_t y;   // the centre's y
  int32_t yy;  // its square
};

// Covers nothing, at |x| < 2^14.5.
constexpr Circle kNoCircle = {0, 0, -0x40000000};

// A part of a column, in grains.
struct Span {
  int32_t low, high;
};

// Flags come first, where short instructions reach them: here and elsewhere.
struct LegalPlaces {
  bool odd[2];          // whether v's column and row are odd
  int32_t turns;        // quarters, counter-clockwise
  int32_t shift;        // of grains: -10 .. 10
  Lines columns, rows;  // of the lattice
  Spot corner[2];       // c, a, below 2^11
  Circle own;           // its centre is below 2^13, its radius below 2^13.5
  Circle behind[2];     // the chord, side 0; kNoCircle if not known, or far
};

#if defined(MICROTIN_LARGE_TABLES)

// Sines of quarters, cosines one further: nothing foretells a branch by them.
constexpr int32_t kSines[5] = {0, 1, 0, -1, 0};

template <class Place>
Place turned(Place p, int32_t turns) {
  const int32_t sine = kSines[turns], cosine = kSines[turns + 1];
  return Place{p.x * cosine - p.y * sine, p.x * sine + p.y * cosine};
}

#else

template <class Place>
Place turned(Place p, int32_t turns) {
  if ((turns & 1) != 0) p = Place{-p.y, p.x};
  return (turns & 2) != 0 ? Place{-p.x, -p.y} : p;
}

#endif

// Both corners, c and a, in `to`.
#if defined(MICROTIN_PAIRS) && defined(__SSE2__)
inline void turn_corners(const FreeRegion& region, int32_t turns, Spot* to) {
  const __m128i corners = _mm_loadu_si128(reinterpret_cast<const __m128i*>(&region.c));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to), turned_both(corners, turns));
}
#else
inline void turn_corners(const FreeRegion& region, int32_t turns, Spot* to) {
  to[0] = turned(region.c, turns);
  to[1] = turned(region.a, turns);
}
#endif

inline int32_t turns_for(Spot a) {
  const bool flat = absolute(a.x) >= absolute(a.y);
  const int32_t way = flat ? a.x : -a.y;
  return (flat ? 0 : 1) + (way < 0 ? 0 : 2);
}

// Twice the centre of the circle through v and `end`, seen from the right of v -> end under k:
// below 2^18, products below 2^29.
inline Spot twice_centre(Spot end, Cotangent k) {
  return Spot{end.x + (k * end.y >> kCotangentBits), end.y - (k * end.x >> kCotangentBits)};
}

// The circle of that centre, which is below 2^15 after the shift: so is its square below 2^30.
inline Circle circle_about(Spot twice, uint32_t shift) {
  const int32_t y = twice.y >> (1 + shift);
  return Circle{twice.x >> shift, y, y * y};
}

// How much coarser grains must be for a centre below 2^13; at most 4.
inline uint32_t coarsening_for(Spot twice) {
  const uint32_t bits = highest_bit(static_cast<uint32_t>(absolute(twice.x >> 1)) |
                                    static_cast<uint32_t>(absolute(twice.y >> 1)) | 1u);
  return bits > 12 ? bits - 12 : 0;
}

inline Spot coarser(Spot p, uint32_t shift) {
  return Spot{p.x >> shift, p.y >> shift};
}

// Whether there is a circle behind a side, and near enough to differ from a line.
inline bool cuts(const Side& side) {
  return side.certified && !side.ghost && side.behind > -kBehindCap * (1 << kCotangentBits);
}

template <class T>
void exchange(T& a, T& b) {
  const T was = a;
  a = b;
  b = was;
}

// Lines 0 to `last` of one axis as seen from line `origin`, forwards or backwards.
inline Lines lines_from(FastInt origin, FastInt last, bool backwards) {
  return backwards ? Lines{origin - last, origin} : Lines{-origin, last - origin};
}

inline void find_lattice(LegalPlaces& places, const Contract& contract, Point origin) {
  FastInt x = origin.x, x_max = contract.x_max, y = origin.y, y_max = contract.y_max;
  bool odd_x = is_odd(x, contract.odd_origin_x), odd_y = is_odd(y, contract.odd_origin_y);
  if ((places.turns & 1) != 0) {
    exchange(x, y);
    exchange(x_max, y_max);
    exchange(odd_x, odd_y);
  }
  places.columns = lines_from(x, x_max, ((places.turns + 1) & 2) != 0);
  places.rows = lines_from(y, y_max, (places.turns & 2) != 0);
  places.odd[0] = odd_x;
  places.odd[1] = odd_y;
}

// That behind a side from v to `end`, seen under k.
MICROTIN_FOLDED void add_circle(LegalPlaces& places, uint32_t i, const Side& side, Spot end,
                                Cotangent k, uint32_t shift) {
  places.behind[i] = cuts(side) ? circle_about(twice_centre(end, k), shift) : kNoCircle;
}

// `own` and `behind` are the cotangents over the chord. Returns its start, turned.
MICROTIN_IN_PLACE inline Spot find_places(LegalPlaces& places, const FreeRegion& region,
                                          const Contract& contract, Cotangent own,
                                          Cotangent behind) {
  places.turns = turns_for(region.corner[1]);
  Spot corner[2];
  turn_corners(region, places.turns, corner);
  const Spot c = corner[0], a = corner[1];
  const Spot centre = twice_centre(a, own);
  const uint32_t shift = coarsening_for(centre);
  places.shift = region.shift - static_cast<int32_t>(shift);
  places.own = circle_about(centre, shift);
  add_circle(places, 0, region.chord, a, behind, shift);
  add_circle(places, 1, region.next, c, -region.next.behind, shift);
  places.corner[0] = coarser(c, shift);
  places.corner[1] = coarser(a, shift);
  find_lattice(places, contract, region.origin);
  return a;
}

// Lines from `low` to `high`, in grains. Where a step has less than one, lines count as far as
// their grain does.
inline Lines lines_within(int32_t low, int32_t high, int32_t shift) {
  if (shift >= 0) {
    return Lines{(low + (static_cast<int32_t>(1) << shift) - 1) >> shift, high >> shift};
  }
  const FastInt steps = static_cast<FastInt>(1) << -shift;
  return Lines{low * steps, (high + 1) * steps - 1};
}

// Twice a coordinate to grains.
inline int32_t grains(FastInt twice, int32_t shift) {
  return shifted(twice, shift - 1);
}

// Whether a place on the own circle is legal as far as sides tell. Of corners and the own circle:
// below 2^27.
inline bool is_open(const LegalPlaces& places, const FreeRegion& region, Spot e) {
  const Spot c = places.corner[0], a = places.corner[1];
  return cross(a, e) <= 0 && !(region.next.certified && cross(c, e) < 0) &&
         !(region.opposite_certified && cross(a - c, e - c) < 0);
}

struct Columns {
  Lines lines;
  bool open_west, open_east;  // whether they end where the circle does; else at a corner
};

inline int32_t root_of(int32_t square) {
  return static_cast<int32_t>(rough_root(static_cast<uint32_t>(square)));
}

// The columns with legal places. That of v is one of them.
inline Columns legal_columns(const LegalPlaces& places, const FreeRegion& region) {
  const Spot centre = {places.own.x2 >> 1, places.own.y};
  const int32_t square = centre.x * centre.x + places.own.yy;
  const int32_t radius = root_of(square | 1) + 1;
  const int32_t c = places.corner[0].x, a = places.corner[1].x;
  int32_t west = c < a ? c : a, east = c > 0 ? c : 0;
  Columns columns;
  const Spot west_end = {centre.x - radius, centre.y}, east_end = {centre.x + radius, centre.y};
  columns.open_west = is_open(places, region, west_end);
  columns.open_east = is_open(places, region, east_end);
  if (columns.open_west && west_end.x < west) west = west_end.x;
  if (columns.open_east && east_end.x > east) east = east_end.x;
  columns.lines = lines_within(west, east, places.shift);
  const Lines& lattice = places.columns;
  if (columns.lines.first < lattice.first) columns.lines.first = lattice.first;
  if (columns.lines.last > lattice.last) columns.lines.last = lattice.last;
  return columns;
}

// Takes away what lies within a circle, at one end.
MICROTIN_IN_PLACE inline void cut(Span& span, int32_t from, int32_t to) {
  if (from <= span.low) {
    if (to > span.low) span.low = to;
  } else if (to >= span.high && from < span.high) {
    span.high = from;
  }
}

// The square of half of what a circle covers at x, below 2^30; negative outside it.
inline int32_t square_at(const Circle& circle, int32_t x) {
  return x * (circle.x2 - x) + circle.yy;
}

// The legal part of the column at x but for the lattice's ends, and what the own circle covers of
// it. Where all places count the circles behind lose what their root may be too large by.
MICROTIN_FOLDED Span legal_span(const LegalPlaces& places, int32_t x, bool all, Span& own) {
  const int32_t square = square_at(places.own, x);
  const int32_t reach = (square > 0 ? root_of(square) : 0) + (all ? 1 : 0);
  own = Span{places.own.y - reach, places.own.y + reach};
  Span span = own;
  for (int i = 0; i < 2; ++i) {
    const Circle& circle = places.behind[i];
    const int32_t covered = square_at(circle, x);
    if (covered <= 0) continue;
    const int32_t root = root_of(covered);
    const int32_t radius = all ? root - (root >> 11) - 1 : root;
    cut(span, circle.y - radius, circle.y + radius);
  }
  return span;
}

// The rows of a span: at least one of the lattice.
inline Lines legal_rows(const LegalPlaces& places, Span span) {
  Lines rows = lines_within(span.low, span.high, places.shift);
  if (rows.first < places.rows.first) rows.first = places.rows.first;
  if (rows.first > places.rows.last) rows.first = places.rows.last;
  if (rows.last > places.rows.last) rows.last = places.rows.last;
  if (rows.last < rows.first) rows.last = rows.first;
  return rows;
}

}  // namespace microtin

#endif
