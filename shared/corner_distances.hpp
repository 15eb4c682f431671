// SPDX-License-Identifier: MIT
// How far places are from the nearest corner of a triangle, as far as that counts.
#ifndef MICROTIN_SHARED_CORNER_DISTANCES_HPP
#define MICROTIN_SHARED_CORNER_DISTANCES_HPP

#include "shared/legal_places.hpp"
#include "shared/vectors.hpp"

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
struct Distances {
  int32_t low, high;
};

// With 16 bits for coordinates and differences, which saturate: whatever does not fit is, saturated
// or not, more than 2^15 - 2^11 away, beyond any reach. x fits, so sums of squares stay below
// 25217^2 + 2^30 < 2^31.
#if defined(__SSE2__)

// Squares are shifted before they are compared: so they, too, may saturate to 16 bits.
inline Distances distances_at(const Reach& reach, const LegalPlaces&, int32_t x, int32_t low,
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
  return Distances{part_of(reach, _mm_extract_epi16(parts, 0)),
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

inline Distances distances_at(const Reach& reach, const LegalPlaces& places, int32_t x, int32_t low,
                              int32_t high) {
  const Spot* const corner = places.corner;
  const int16x2_t c = pair_of(corner[0].x, corner[0].y), a = pair_of(corner[1].x, corner[1].y);
  return Distances{distance_of(reach, c, a, pair_of(x, low)),
                   distance_of(reach, c, a, pair_of(x, high))};
}

#endif

#endif

}  // namespace microtin

#endif
