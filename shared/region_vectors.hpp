// SPDX-License-Identifier: MIT
// Corners and products of a free region side by side, where the machine has SSE2.
#ifndef MICROTIN_SHARED_REGION_VECTORS_HPP
#define MICROTIN_SHARED_REGION_VECTORS_HPP

#include "shared/pairs.hpp"

#if defined(MICROTIN_PAIRS) && defined(__SSE2__)

namespace microtin {

template <int kNumber>
int32_t lane(__m128i v) {
  return _mm_cvtsi128_si32(_mm_shuffle_epi32(v, kNumber));
}

// Coordinates with 32 bits: those of a, then of b.
inline __m128i both_of(Point a, Point b) {
  return _mm_unpacklo_epi16(_mm_unpacklo_epi32(pair_of(a), pair_of(b)), _mm_setzero_si128());
}

inline __m128i place_of(Point p) {
  return _mm_unpacklo_epi16(pair_of(p), _mm_setzero_si128());
}

inline __m128i magnitudes(__m128i v) {
  const __m128i sign = _mm_srai_epi32(v, 31);
  return _mm_sub_epi32(_mm_xor_si128(v, sign), sign);
}

// Has the highest bit of the longest coordinate of two places.
inline uint32_t extent_of_both(__m128i v) {
  const __m128i sizes = magnitudes(v);
  const __m128i sums = _mm_or_si128(sizes, _mm_shuffle_epi32(sizes, 0x4E));
  return static_cast<uint32_t>(
      _mm_cvtsi128_si32(_mm_or_si128(sums, _mm_shuffle_epi32(sums, 0xB1))));
}

// The extent of the first place.
inline uint32_t extent_of_first(__m128i v) {
  const __m128i sizes = magnitudes(v);
  return static_cast<uint32_t>(
      _mm_cvtsi128_si32(_mm_or_si128(sizes, _mm_shuffle_epi32(sizes, 0xB1))));
}

// Two places, below 2^15, turned by so many quarters: what x of both, then y, are made of.
inline __m128i turned_both(__m128i v, int32_t turns) {
  static constexpr int16_t kFactors[4][8] = {{1, 0, 1, 0, 0, 1, 0, 1},
                                             {0, -1, 0, -1, 1, 0, 1, 0},
                                             {-1, 0, -1, 0, 0, -1, 0, -1},
                                             {0, 1, 0, 1, -1, 0, -1, 0}};
  const __m128i factors = _mm_loadu_si128(reinterpret_cast<const __m128i*>(kFactors[turns]));
  return _mm_shuffle_epi32(_mm_madd_epi16(_mm_packs_epi32(v, v), factors), 0xD8);
}

// v * 2^shift, rounded down; |v| < 2^16, -5 <= shift <= 10.
inline __m128i all_shifted(__m128i v, int32_t shift) {
  return _mm_sra_epi32(_mm_slli_epi32(v, 15), _mm_cvtsi32_si128(15 - shift));
}

// Products of places c and a, below 2^11: c . c, a . a, c . a, c x a.
inline __m128i products_of(__m128i both) {
  const __m128i pairs = _mm_packs_epi32(both, both);
  const __m128i from = _mm_shuffle_epi32(pairs, 0x04);                           // c, a, c, c
  const __m128i to = _mm_shufflehi_epi16(_mm_shuffle_epi32(pairs, 0x54), 0xB4);  // c, a, a, a
  return _mm_madd_epi16(from, _mm_mullo_epi16(to, _mm_set_epi16(-1, 1, 1, 1, 1, 1, 1, 1)));
}

// The view of places d and `end`, below 2^11: d . (end - d) in the first lane, and in the third
// d x end, or end x d if `turn` is 1.
inline __m128i view_of(__m128i d, __m128i end, int32_t turn) {
  const __m128i turned = _mm_shuffle_epi32(end, 0xB1);
  const __m128i from =
      turn < 0 ? _mm_set_epi16(0, 0, -1, 1, 0, 0, 1, 1) : _mm_set_epi16(0, 0, 1, -1, 0, 0, 1, 1);
  const __m128i to = _mm_packs_epi32(_mm_sub_epi32(end, d), turned);
  return _mm_madd_epi16(_mm_mullo_epi16(_mm_packs_epi32(d, d), from), to);
}

}  // namespace microtin

#endif

#endif
