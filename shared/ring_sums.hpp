// SPDX-License-Identifier: MIT
// What the neighbours of a new vertex add up to: their heights, and how far these were from what
// was predicted.
#ifndef MICROTIN_SHARED_RING_SUMS_HPP
#define MICROTIN_SHARED_RING_SUMS_HPP

#include "shared/mesh.hpp"
#include "shared/pairs.hpp"

namespace microtin {

// What is kept of a vertex's difference from its prediction.
typedef int8_t Residual;

// The ring of a new vertex has at most 32 neighbours; each weighs 1 / distance^2, rounded to a
// power of two: 2^5 if it is as far as the first, at most 2^9, nothing below 1.
struct RingSums {
  uint32_t weights;    // 2^5 .. 31 * 2^9 + 2^5
  int32_t heights;     // weighted, less that of the first: within +-2^30
  uint32_t spread;     // of their magnitudes
  int32_t residuals;   // weighted: within +-2^21
  uint32_t roughness;  // of their magnitudes
  uint32_t first;      // distance_bits of the first neighbour
};

constexpr int32_t kFirstBits = 5, kMostBits = 9;  // of weights

// The position of the highest bit of half the squared distance, which is below 2^32; 0 for 1.
// Halving the squares or their sum is the same to it: two odd squares add up to 2 modulo 8.
#if UINTPTR_MAX > 0xFFFFFFFFu
inline uint32_t distance_bits(Point a, Point b) {
  const FastInt dx = static_cast<FastInt>(a.x) - b.x, dy = static_cast<FastInt>(a.y) - b.y;
  return highest_bit(static_cast<uint32_t>((dx * dx + dy * dy) >> 1) | 1u);
}
#else
MICROTIN_ONE_COPY inline uint32_t distance_bits(Point a, Point b) {
  const uint32_t dx = static_cast<uint32_t>(a.x) - b.x, dy = static_cast<uint32_t>(a.y) - b.y;
  return highest_bit(((dx * dx >> 1) + (dy * dy >> 1)) | 1u);  // squares are right modulo 2^32
}
#endif

#if defined(MICROTIN_PAIRS) && defined(__SSE2__)

// Height, residual and weight side by side.
class RingTally {
 public:
  RingTally() : sums_(_mm_setzero_si128()), magnitudes_(_mm_setzero_si128()) {}

  void add(int32_t height, int32_t residual, int32_t bits) {
    const __m128i weighted =
        _mm_sll_epi32(_mm_set_epi32(0, 1, residual, height), _mm_cvtsi32_si128(bits));
    sums_ = _mm_add_epi32(sums_, weighted);
    magnitudes_ = _mm_add_epi32(magnitudes_, magnitudes(weighted));
  }

  RingSums sums(uint32_t first) const {
    return RingSums{static_cast<uint32_t>(lane<2>(sums_)),       lane<0>(sums_),
                    static_cast<uint32_t>(lane<0>(magnitudes_)), lane<1>(sums_),
                    static_cast<uint32_t>(lane<1>(magnitudes_)), first};
  }

 private:
  __m128i sums_, magnitudes_;
};

#else

inline uint32_t magnitude_of(int32_t v) {
  return static_cast<uint32_t>(v < 0 ? -v : v);
}

class RingTally {
 public:
  RingTally() : sums_{0, 0, 0, 0, 0, 0} {}

  void add(int32_t height, int32_t residual, int32_t bits) {
    const int32_t weight = static_cast<int32_t>(1) << bits;
    height *= weight;
    residual *= weight;
    sums_.weights += static_cast<uint32_t>(weight);
    sums_.heights += height;
    sums_.spread += magnitude_of(height);
    sums_.residuals += residual;
    sums_.roughness += magnitude_of(residual);
  }

  RingSums sums(uint32_t first) {
    sums_.first = first;
    return sums_;
  }

 private:
  RingSums sums_;
};

#endif

// The sums over vertices some of which may be kInfinity, but not the first.
inline RingSums sum_ring(const Mesh& mesh, const Residual* residual, const Index* ring,
                         uint32_t size, Point place) {
  const Index a = ring[0];
  const int32_t base = mesh.z[a];
  const uint32_t first = distance_bits(point_of(mesh, a), place);
  RingTally tally;
  tally.add(0, residual[a], kFirstBits);
  const int32_t most = static_cast<int32_t>(first) + kFirstBits;
  for (uint32_t i = 1; i < size; ++i) {
    const Index v = ring[i];
    if (v == kInfinity) continue;
    const int32_t bits = most - static_cast<int32_t>(distance_bits(point_of(mesh, v), place));
    if (bits < 0) continue;
    tally.add(mesh.z[v] - base, residual[v], bits < kMostBits ? bits : kMostBits);
  }
  return tally.sums(first);
}

}  // namespace microtin

#endif
