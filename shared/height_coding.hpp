// SPDX-License-Identifier: MIT
// Coding of a new vertex's height as the difference from what its neighbours predict: by what their
// heights, and their own differences, add up to.
#ifndef MICROTIN_SHARED_HEIGHT_CODING_HPP
#define MICROTIN_SHARED_HEIGHT_CODING_HPP

#include "shared/format.hpp"
#include "shared/mesh.hpp"
#include "shared/pairs.hpp"
#include "shared/probability.hpp"

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

// Magnitudes: the number of bits, then the bit behind the leading one, then uniform bits.
constexpr uint32_t kMagnitudeBits = 17;  // a difference of heights is below 2^17
constexpr uint32_t kExponents = 7;       // numbers of bits kept apart: three around the typical one
constexpr uint32_t kMantissas = 10;      // numbers of bits kept apart; larger ones share the last

struct ExponentModel {
  AdaptiveBit longer[kExponents];  // than typical - 3 .. typical + 3 bits
};

struct MantissaModel {
  AdaptiveBit second[kMantissas];
};

// Codes a number of bits up to kMagnitudeBits: upwards or downwards from the typical one, which is
// smaller.
template <class Coder>
uint32_t code_exponent(Coder& coder, ExponentModel& model, uint32_t typical, uint32_t value) {
  uint32_t bits = typical, i = kExponents / 2;
  const bool upwards = code_bit(coder, model.longer[i], bits < value);
  do {
    bits = upwards ? bits + 1 : bits - 1;  // below 0 is above all
    if (upwards && i != kExponents - 1) ++i;
    if (!upwards && i != 0) --i;
  } while (bits < kMagnitudeBits && code_bit(coder, model.longer[i], bits < value) == upwards);
  return upwards ? bits : bits + 1;
}

// Codes a magnitude below 2^kMagnitudeBits.
template <class Coder>
uint32_t code_magnitude(Coder& coder, ExponentModel& exponent, MantissaModel& mantissa,
                        uint32_t typical_bits, uint32_t value) {
  const uint32_t bits =
      code_exponent(coder, exponent, typical_bits, value == 0 ? 0 : highest_bit(value) + 1);
  if (bits <= 1) return bits;
  AdaptiveBit& second = mantissa.second[bits < kMantissas ? bits : kMantissas - 1];
  const uint32_t leading = 2u + code_bit(coder, second, (value >> (bits - 2) & 1u) != 0);
  const uint32_t rest = static_cast<uint32_t>(1) << (bits - 2);
  return leading * rest + coder.uniform(rest, value & (rest - 1u));
}

constexpr uint32_t kScales = 12;      // contexts: how large a difference is to be expected
constexpr uint32_t kTendencies = 10;  // contexts: of which sign, from below the prediction to above
constexpr uint32_t kSignSizes = 3;    // differences of 1, 2, 3 or more

struct HeightModel {
  ExponentModel exponent[kScales];
  MantissaModel mantissa;
  AdaptiveBit negative[kTendencies][kSignSizes];
};

inline Residual residual_of(int32_t difference) {
  return static_cast<Residual>(difference < -127 ? -127 : difference > 127 ? 127 : difference);
}

struct HeightPrediction {
  int32_t height;
  uint32_t scale;     // < kScales: of the difference to be expected
  uint32_t tendency;  // < kTendencies: towards which sign
};

// The larger the differences around here, the spread of the ring and the distance, the larger the
// difference to be expected.
inline uint32_t expected_scale(uint32_t weights, uint32_t roughness, uint32_t spread,
                               uint32_t distance) {
  // No logarithm is smaller than that of a smaller number: the sum is positive.
  const Log2 sum = rough_log2(4 * roughness + weights) + 2 * rough_log2(4 * spread + weights) -
                   3 * rough_log2(weights) + 32 * static_cast<Log2>(distance) + 320;
  const uint32_t scale = static_cast<uint32_t>(sum) / 768u;
  return scale < kScales ? scale : kScales - 1;
}

// 0 .. 4: neighbours above their own predictions make it likely that the new vertex is, too.
inline uint32_t expected_sign(int32_t residuals, int32_t roughness) {
  const int32_t sum = 5 * residuals;
  return static_cast<uint32_t>((sum >= -3 * roughness) + (sum >= -roughness) + (sum > roughness) +
                               (sum > 3 * roughness));
}

// Predicts from the ring's vertex numbers, of which the first is finite and some may be kInfinity.
inline HeightPrediction predict_height(const Mesh& mesh, const Residual* residual,
                                       const Index* ring, uint32_t size, Point place) {
  const RingSums sums = sum_ring(mesh, residual, ring, size, place);
  // Rounded to nearest, halves up. 2^16 is added to stay positive: all is below 2^32.
  const uint32_t divisor = 2u * sums.weights;  // not 0
  const uint32_t dividend =
      static_cast<uint32_t>(2 * sums.heights) + sums.weights + (divisor << 16);
  const uint32_t mean = dividend / divisor;
  const bool rounded_down = dividend - mean * divisor > sums.weights;
  HeightPrediction prediction;
  prediction.height = mesh.z[ring[0]] + static_cast<int32_t>(mean) - 65536;
  prediction.scale = expected_scale(sums.weights, sums.roughness, sums.spread,
                                    14u + sums.first - highest_bit(sums.weights));
  prediction.tendency =
      2u * expected_sign(sums.residuals, static_cast<int32_t>(sums.roughness)) + rounded_down;
  return prediction;
}

// Codes a height given its prediction. False if the stream's height does not fit 16 bits.
template <class Coder>
bool code_height(Coder& coder, HeightModel& model, const HeightPrediction& prediction, int16_t* z) {
  const int32_t difference = static_cast<int32_t>(*z) - prediction.height;
  const uint32_t magnitude =
      code_magnitude(coder, model.exponent[prediction.scale], model.mantissa, prediction.scale / 2,
                     static_cast<uint32_t>(difference < 0 ? -difference : difference));
  int32_t height = prediction.height;
  if (magnitude != 0) {
    AdaptiveBit* const negative = model.negative[prediction.tendency];
    const uint32_t size = (magnitude < kSignSizes ? magnitude : kSignSizes) - 1u;
    const int32_t step = static_cast<int32_t>(magnitude);
    height += code_bit(coder, negative[size], difference < 0) ? -step : step;
  }
  if (height < -32768 || height > 32767) return false;
  *z = static_cast<int16_t>(height);
  return true;
}

}  // namespace microtin

#endif
