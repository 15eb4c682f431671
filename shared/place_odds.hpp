// SPDX-License-Identifier: MIT
// How likely legal places are, by their distances from the corners of the triangle.
#ifndef MICROTIN_SHARED_PLACE_ODDS_HPP
#define MICROTIN_SHARED_PLACE_ODDS_HPP

#include "shared/legal_places.hpp"
#include "shared/pairs.hpp"

namespace microtin {

// The squared distance, in grains, from which on nothing counts, at most 2^28, and the shift that
// brings it below 2^15; 255 / it, shifted.
struct Reach {
  int32_t square;
  uint32_t shift, factor;
#if defined(MICROTIN_PAIRS) && defined(__SSE2__)
  int32_t shifted;    // the square, in both halves
  int32_t corner[4];  // c, c, a, a, with 16 bits for coordinates
#endif
};

// `square` is its logarithm, 2 .. 28.
inline Reach reach_of(Log2 square, const LegalPlaces& places) {
  const uint32_t bits = static_cast<uint32_t>(square) >> 8;
  Reach reach;
  reach.square = static_cast<int32_t>(rough_exp2(square));
  reach.shift = bits > 14 ? bits - 14 : 0;
  const int32_t shifted = reach.square >> reach.shift;
  reach.factor = 255u * 65536u / static_cast<uint32_t>(shifted);
#if defined(MICROTIN_PAIRS) && defined(__SSE2__)
  reach.shifted = shifted << 16 | shifted;
  const __m128i corners = _mm_loadu_si128(reinterpret_cast<const __m128i*>(places.corner));
  const __m128i pairs = _mm_packs_epi32(corners, corners);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(reach.corner), _mm_unpacklo_epi32(pairs, pairs));
#else
  static_cast<void>(places);
#endif
  return reach;
}

inline int32_t squared_distance(Spot p, int32_t x, int32_t y) {
  return (p.x - x) * (p.x - x) + (p.y - y) * (p.y - y);  // < 2^30.5
}

// 255 times a squared distance, at most the reach and shifted, over that: 0..255.
inline int32_t part_of(const Reach& reach, int32_t square) {
  return static_cast<int32_t>(static_cast<uint32_t>(square) * reach.factor >> 16);
}

// 0..255, from the corners v, c and a. |x| < 2^14.5, |y| < 2^15.2.
inline int32_t distance_at(const Reach& reach, const LegalPlaces& places, int32_t x, int32_t y) {
  const int32_t from_v = x * x + y * y;
  const int32_t from_c = squared_distance(places.corner[0], x, y);
  const int32_t from_a = squared_distance(places.corner[1], x, y);
  int32_t least = from_v < reach.square ? from_v : reach.square;
  if (from_c < least) least = from_c;
  if (from_a < least) least = from_a;
  return part_of(reach, least >> reach.shift);
}

#if defined(MICROTIN_PAIRS)

// The distances of two places of a column.
struct ColumnDistances {
  int32_t low, high;
};

// With 16 bits for coordinates and differences, which saturate: whatever does not fit is, saturated
// or not, more than 2^15 - 2^11 away, beyond any reach. x fits, so sums of squares stay below
// 25217^2 + 2^30 < 2^31.
#if defined(__SSE2__)

// Squares are shifted before they are compared: so they, too, may saturate to 16 bits.
inline ColumnDistances distances_at(const Reach& reach, const LegalPlaces&, int32_t x, int32_t low,
                                    int32_t high) {
  const __m128i y = _mm_unpacklo_epi32(_mm_cvtsi32_si128(low), _mm_cvtsi32_si128(high));
  const __m128i xx = _mm_shufflelo_epi16(_mm_cvtsi32_si128(x), 0);
  const __m128i both = _mm_unpacklo_epi16(xx, _mm_packs_epi32(y, y));
  const __m128i from = _mm_shuffle_epi32(both, 0x44);  // low, high, low, high
  const __m128i corners = _mm_loadu_si128(reinterpret_cast<const __m128i*>(reach.corner));
  const __m128i to = _mm_subs_epi16(corners, from);
  const __m128i shift = _mm_cvtsi32_si128(static_cast<int>(reach.shift));
  const __m128i squares = _mm_packs_epi32(_mm_srl_epi32(_mm_madd_epi16(to, to), shift),
                                          _mm_srl_epi32(_mm_madd_epi16(from, from), shift));
  const __m128i least = _mm_min_epi16(squares, _mm_shuffle_epi32(squares, 0x4E));
  const __m128i nearest = _mm_min_epi16(least, _mm_shuffle_epi32(least, 0xB1));
  const __m128i parts = _mm_min_epi16(nearest, _mm_cvtsi32_si128(reach.shifted));
  return ColumnDistances{part_of(reach, _mm_extract_epi16(parts, 0)),
                         part_of(reach, _mm_extract_epi16(parts, 1))};
}

#else

inline int16x2_t pair_of(int32_t x, int32_t y) {
  return static_cast<int16x2_t>((static_cast<uint32_t>(x) & 0xFFFFu) |
                                static_cast<uint32_t>(kept_within(y, -32768, 32767)) << 16);
}

inline int32_t squared(int16x2_t way) {
  return __smuad(way, way);
}

inline int32_t distance_of(const Reach& reach, int16x2_t c, int16x2_t a, int16x2_t from) {
  const int32_t from_v = squared(from);
  const int32_t from_c = squared(__qsub16(c, from));
  const int32_t from_a = squared(__qsub16(a, from));
  int32_t least = from_v < reach.square ? from_v : reach.square;
  if (from_c < least) least = from_c;
  if (from_a < least) least = from_a;
  return part_of(reach, least >> reach.shift);
}

inline ColumnDistances distances_at(const Reach& reach, const LegalPlaces& places, int32_t x,
                                    int32_t low, int32_t high) {
  const Spot* const corner = places.corner;
  const int16x2_t c = pair_of(corner[0].x, corner[0].y), a = pair_of(corner[1].x, corner[1].y);
  return ColumnDistances{distance_of(reach, c, a, pair_of(x, low)),
                         distance_of(reach, c, a, pair_of(x, high))};
}

#endif

#endif

// How likely legal places are.
//
// A place weighs the chance that no other point came first there: the walk inserts the point whose
// circle through the chord is the smallest, and with density points per unit area a circle that
// sweeps an area s over the chord is the first with probability exp(-density * s). And vertices of
// a terrain keep apart: places close to a corner of the triangle are the rarer the closer they are.
// How close counts is learned.

// How close vertices come: over the points per unit area, the inverse of a squared distance, such
// that one in 192 * 256 / crowding places is closer than that to a corner. 8 fractional bits.
typedef uint32_t Crowding;
constexpr Crowding kCrowdingStart = 2048, kCrowdingLeast = 512, kCrowdingMost = 65536;

// 511 * chance of being first, along a third of the way from the triangle's circle to that behind
// the chord, which is 768 long: at f of it, (start + f slope) >> 8.
struct Third {
  int32_t start, slope;
};

struct PlaceOdds {
  bool repels;
  Third third[3];
  // The power of a place with respect to the circle behind less that to the triangle's: across.x x
  // + across.y y, both below 2^16.
  Spot across;
  Reach reach;  // of repulsion
};

// 511 * chance of being first after twice the swept area; `rate` is the logarithm of the density by
// that unit, times log2(e), with 8 fractional bits more. |rate| < 2^15.
inline int32_t chance_after(int32_t twice, Log2 rate) {
  if (twice <= 0) return 511;
  const Log2 loss = rough_log2(static_cast<uint32_t>(twice)) + rate;
  if (loss >= 12 * kLog2One) return 0;
  return static_cast<int32_t>(rough_exp2(9 * kLog2One - 1 - static_cast<Log2>(rough_exp2(loss))));
}

// `a` is the chord's start, turned, `density` the logarithm of points per unit area, `own` and
// `behind` are the cotangents over the chord.
inline void estimate_sweep(PlaceOdds& odds, const LegalPlaces& places, const FreeRegion& region,
                           Spot a, Log2 density, Cotangent own, Cotangent behind) {
  // log2(log2(e)) = 135 / 256; of the density 7 / 8, log2 of which is -49 / 256, suits best.
  const Log2 rate = density - (2 * region.shift + 1) * kLog2One + 135 - 49 + 8 * kLog2One;
  const uint32_t square = static_cast<uint32_t>(region.aa);
  const int32_t start = cap(square, behind);
  const Cotangent step = (own - behind) / 3;
  Cotangent k = own - 2 * step;
  int32_t last = 511;
  for (int i = 2; i >= 0; --i, k += step) {
    const int32_t first = chance_after(cap(square, k) - start, rate);
    const int32_t slope = last - first;
    odds.third[i] = Third{256 * (first - i * slope), slope};
    last = first;
  }
  const uint32_t shift = static_cast<uint32_t>(region.shift - places.shift) + kCotangentBits;
  odds.across = Spot{(own - behind) * a.y >> shift, (behind - own) * a.x >> shift};  // < 2^30
}

inline void estimate_repulsion(PlaceOdds& odds, const LegalPlaces& places, Log2 density,
                               Crowding crowding) {
  // log2 of what is 255 / 2^16 of the inverse of the squared distance that counts.
  const Log2 inverse = rough_log2(crowding) - 8 * kLog2One + density - 2 * places.shift * kLog2One;
  odds.reach = reach_of(kept_within(-inverse, 2 * kLog2One, 28 * kLog2One), places);
}

// A column, in grains, and what the own circle covers of it.
struct Column {
  int32_t x;
  Span own;
};

// 0..511. Near the own circle: |x|, |y| < 2^14.5. Next to it, and beyond the chord, what is
// negative is taken for a large number: the chance is then 511 or that on the triangle's circle.
inline int32_t chance_at(const PlaceOdds& odds, const Column& column, int32_t y) {
  const int32_t all = odds.across.x * column.x + odds.across.y * y;  // < 2^31
  const int32_t above = column.own.high - y, below = y - column.own.low;
  const int32_t left = above * below;  // < 2^28
  const uint32_t f = static_cast<uint32_t>(left) / ((static_cast<uint32_t>(all) >> 8) + 1);
  if (f >= 256) return 511;
  const uint32_t way = 3 * f;
  const Third& third = odds.third[way >> 8];
  return (third.start + static_cast<int32_t>(way) * third.slope) >> 8;
}

// The weights of two places, or of all in two halves.
struct Halves {
  uint32_t low, high;  // weights: below 2^15.6, times a count below 2^19.6
};

inline uint32_t weight_at(const PlaceOdds& odds, const LegalPlaces& places, const Column& column,
                          int32_t y) {
  int32_t weight = chance_at(odds, column, y);
  if (odds.repels) weight = weight * (distance_at(odds.reach, places, column.x, y) + 4) >> 8;
  return static_cast<uint32_t>(weight) + 4u;
}

#if defined(MICROTIN_PAIRS)

// The weights of two places of a column: 4..520 each.
inline Halves weights_at(const PlaceOdds& odds, const LegalPlaces& places, const Column& column,
                         int32_t low, int32_t high) {
  int32_t first = chance_at(odds, column, low), second = chance_at(odds, column, high);
  if (odds.repels) {
    const ColumnDistances distance = distances_at(odds.reach, places, column.x, low, high);
    first = first * (distance.low + 4) >> 8;
    second = second * (distance.high + 4) >> 8;
  }
  return Halves{static_cast<uint32_t>(first) + 4u, static_cast<uint32_t>(second) + 4u};
}

#else

inline Halves weights_at(const PlaceOdds& odds, const LegalPlaces& places, const Column& column,
                         int32_t low, int32_t high) {
  return Halves{weight_at(odds, places, column, low), weight_at(odds, places, column, high)};
}

#endif

// The weight of a column: its legal length times the mean weight, which places near its ends tell
// best. 4..2^14.6.
MICROTIN_ROOMY_IN_PLACE uint32_t column_weight(const PlaceOdds& odds, const LegalPlaces& places,
                                               int32_t x) {
  Column column;
  column.x = x;
  const Span legal = legal_span(places, x, false, column.own);
  const int32_t length = legal.high - legal.low;
  if (length <= 0) return 4;
  const int32_t eighth = length >> 3;
  const Halves weight = weights_at(odds, places, column, legal.low + eighth, legal.high - eighth);
  return (static_cast<uint32_t>(length) * (weight.low + weight.high) >> 10) + 4u;
}

// `place` in grains: where the point was.
inline void learn(Crowding& crowding, const PlaceOdds& odds, const LegalPlaces& places,
                  Spot place) {
  if (distance_at(odds.reach, places, place.x, place.y) < 254) crowding += crowding >> 4;
  crowding -= 12;
  if (crowding < kCrowdingLeast) crowding = kCrowdingLeast;
  if (crowding > kCrowdingMost) crowding = kCrowdingMost;
}

}  // namespace microtin

#endif
