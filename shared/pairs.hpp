// SPDX-License-Identifier: MIT
// Several 16-bit numbers at once, where the machine multiplies two pairs of them (MICROTIN_PAIRS):
// in-circle tests of points near one another, and the corners of a free region.
#ifndef MICROTIN_SHARED_PAIRS_HPP
#define MICROTIN_SHARED_PAIRS_HPP

#include "shared/compiler.hpp"
#include "shared/predicates.hpp"

// Which instructions for several 16-bit numbers at once the machine has: MICROTIN_PAIRS if it
// multiplies two pairs of them.

#if defined(__SSE2__) && defined(__x86_64__) && !defined(__OPTIMIZE_SIZE__)
#define MICROTIN_PAIRS
// gcc's emmintrin.h includes mm_malloc.h, for which a freestanding <stdlib.h> has no malloc, or is
// not there. Nothing here allocates.
#if !defined(__clang__) && !__STDC_HOSTED__ && !defined(_MM_MALLOC_H_INCLUDED)
#define _MM_MALLOC_H_INCLUDED
#include <emmintrin.h>
#undef _MM_MALLOC_H_INCLUDED
#else
#include <emmintrin.h>
#endif
#elif defined(__ARM_FEATURE_DSP) && defined(__ARM_FEATURE_SIMD32) && !defined(__OPTIMIZE_SIZE__)
#define MICROTIN_PAIRS
#include <arm_acle.h>
#endif

// Both coordinates of a point in one word, where the machine multiplies two pairs of 16-bit numbers
// at once (MICROTIN_PAIRS): in-circle tests of points near one another.

#if defined(MICROTIN_PAIRS)

namespace microtin {

// A window is a square of 2^15 x 2^15 places. Of a point in it, both coordinates less those of its
// least corner are below 2^15; of any other point one of them, modulo 2^16, is not, as the corner
// is within 2^15 of both ends of the lattice.
constexpr uint32_t kWindow = 0x8000;
constexpr uint32_t kOutside = 0x80008000u;  // the bits that tell
static_assert(kLatticeMax - kWindow < kWindow, "offsets below -2^15 are none of a window's corner");

inline uint32_t packed(uint32_t x, uint32_t y) {
  return x | y << 16;
}

// Differences of points in a window are within +-(2^15 - 1), so dot and cross products are below
// 2^31, the products of two of these below 2^62, and their difference is below 2^63.
static_assert(2 * int64_t{kWindow - 1} * (kWindow - 1) <= INT32_MAX, "a dot product fits");

#if defined(__SSE2__)

// In the lowest 32-bit lane, x in its lower half; what the others hold does not matter.
typedef __m128i Pair;

inline Pair pair_of(uint32_t bits) {
  return _mm_cvtsi32_si128(static_cast<int32_t>(bits));
}

inline Pair pair_of(Point p) {
  return pair_of(packed(p.x, p.y));
}

inline Pair difference(Pair a, Pair b) {
  return _mm_sub_epi16(a, b);
}

inline Pair either(Pair a, Pair b) {
  return _mm_or_si128(a, b);
}

inline bool is_outside(Pair a) {
  return (static_cast<uint32_t>(_mm_cvtsi128_si32(a)) & kOutside) != 0;
}

// As incircle(Point, Point, Point, Point), of points in one window.
inline int64_t incircle(Pair a, Pair b, Pair c, Pair p) {
  // What c sees in the first lane, what p sees in the second.
  const __m128i eye = _mm_unpacklo_epi32(c, p);
  const __m128i to_a = _mm_sub_epi16(_mm_shuffle_epi32(a, 0), eye);
  const __m128i to_b = _mm_sub_epi16(_mm_shuffle_epi32(b, 0), eye);
  const __m128i turned =  // (y, -x)
      _mm_mullo_epi16(_mm_shufflelo_epi16(to_b, 0xB1), _mm_set1_epi32(-65535));
  const int64_t q = _mm_cvtsi128_si64(_mm_madd_epi16(to_a, to_b));
  const int64_t h = _mm_cvtsi128_si64(_mm_madd_epi16(to_a, turned));
  return static_cast<int32_t>(q) * (h >> 32) - (q >> 32) * static_cast<int32_t>(h);
}

// Differences below 0 become 0.
inline Pair excess(Pair a, Pair b) {
  return _mm_subs_epu16(a, b);
}

#else

typedef uint32_t Pair;  // x in the lower half

inline Pair pair_of(uint32_t bits) {
  return bits;
}

inline Pair pair_of(Point p) {
  return packed(p.x, p.y);
}

inline Pair difference(Pair a, Pair b) {
  return static_cast<Pair>(__ssub16(static_cast<int16x2_t>(a), static_cast<int16x2_t>(b)));
}

inline Pair either(Pair a, Pair b) {
  return a | b;
}

inline bool is_outside(Pair a) {
  return (a & kOutside) != 0;
}

// As incircle(Point, Point, Point, Point), of points in one window.
inline int64_t incircle(Pair a, Pair b, Pair c, Pair p) {
  const int16x2_t from_c = static_cast<int16x2_t>(c), from_p = static_cast<int16x2_t>(p);
  const int16x2_t ca = __ssub16(static_cast<int16x2_t>(a), from_c);
  const int16x2_t cb = __ssub16(static_cast<int16x2_t>(b), from_c);
  const int16x2_t pa = __ssub16(static_cast<int16x2_t>(a), from_p);
  const int16x2_t pb = __ssub16(static_cast<int16x2_t>(b), from_p);
  return static_cast<int64_t>(__smuad(ca, cb)) * __smusdx(pa, pb) -
         static_cast<int64_t>(__smuad(pa, pb)) * __smusdx(ca, cb);
}

inline Pair excess(Pair a, Pair b) {
  return static_cast<Pair>(__uqsub16(static_cast<uint16x2_t>(a), static_cast<uint16x2_t>(b)));
}

#endif

// The least corner of a window around p, kept within 0 .. 2^15.
inline Pair window_around(Pair p) {
  const Pair begin = excess(p, pair_of(0x40004000u));
  return difference(begin, excess(begin, pair_of(0x80008000u)));
}

}  // namespace microtin

#endif

// Corners and products of a free region side by side, where the machine has SSE2.

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

// Two places below 2^15, both turned by the same quarters: what x of both, then y, come from.
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
