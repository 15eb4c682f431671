// SPDX-License-Identifier: MIT
// Coding of a new vertex's height as the difference from what its neighbours predict.
#ifndef MICROTIN_SHARED_HEIGHT_CODING_HPP
#define MICROTIN_SHARED_HEIGHT_CODING_HPP

#include "shared/format.hpp"
#include "shared/probability.hpp"
#include "shared/ring_sums.hpp"

namespace microtin {

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
