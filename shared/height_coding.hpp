// Coding of a new vertex's height as the difference from what its neighbours predict.
#ifndef MICROTIN_SHARED_HEIGHT_CODING_HPP
#define MICROTIN_SHARED_HEIGHT_CODING_HPP

#include "shared/mesh.hpp"
#include "shared/probability.hpp"

namespace microtin {

constexpr int kMagnitudeBits = 17;  // a difference of heights is below 2^17
constexpr int kExponents = 10;      // numbers of bits told apart; larger ones share the last
constexpr int kRoughnesses = 12;    // contexts: how large differences were around here

// Magnitudes: the number of bits in unary, then the bit behind the leading one, then uniform bits.
struct ExponentModel {
  AdaptiveBit longer[kExponents];
};

struct MantissaModel {
  AdaptiveBit second[kExponents];
};

inline void reset(ExponentModel& model, int typical_bits) {
  for (int i = 0; i < kExponents; ++i) {
    reset(model.longer[i], i < typical_bits ? 24000u : i == typical_bits ? 16384u : 8000u);
  }
}

inline void reset(MantissaModel& model) {
  for (int i = 0; i < kExponents; ++i) reset(model.second[i], 14000);
}

// Codes a magnitude below 2^most_bits.
template <class Coder>
uint32_t code_magnitude(Coder& coder, ExponentModel& exponent, MantissaModel& mantissa,
                        uint32_t most_bits, uint32_t value) {
  const uint32_t value_bits = value == 0 ? 0 : highest_bit(value) + 1;
  uint32_t bits = 0;
  while (bits < most_bits &&
         code_bit(coder, exponent.longer[bits < kExponents ? bits : kExponents - 1],
                  bits < value_bits)) {
    ++bits;
  }
  if (bits <= 1) return bits;
  AdaptiveBit& second = mantissa.second[bits < kExponents ? bits : kExponents - 1];
  uint32_t result = 2u + code_bit(coder, second, (value >> (bits - 2) & 1u) != 0);
  if (bits > 2) {
    const uint32_t rest = static_cast<uint32_t>(1) << (bits - 2);
    result = result * rest + coder.uniform(rest, value & (rest - 1u));
  }
  return result;
}

struct HeightModel {
  ExponentModel exponent[kRoughnesses];
  MantissaModel mantissa;
  AdaptiveBit negative;
};

inline void reset(HeightModel& model) {
  for (int i = 0; i < kRoughnesses; ++i) reset(model.exponent[i], i / 2);
  reset(model.mantissa);
  reset(model.negative, 16384);
}

// What the ring of a new vertex says about its height.
struct HeightPrediction {
  int32_t height;
  uint32_t roughness;  // 4 * log2 of the size of the difference to be expected
};

// Each ring vertex weighs 1 / distance^2, scaled so that the nearest weighs 2^12. `ring` holds up
// to 32 vertex numbers, kInfinity among them; at least two are finite. Sums: 32 * 2^12 * 2^15 =
// 2^32 needs 64 bits.
inline HeightPrediction predict_height(const Mesh& mesh, const uint8_t* roughness,
                                       const Index* ring, uint32_t size, Point place) {
  int64_t nearest = INT64_MAX;
  for (uint32_t i = 0; i < size; ++i) {
    if (ring[i] == kInfinity) continue;
    const int64_t d = squared_length(point_of(mesh, ring[i]), place);
    if (d < nearest) nearest = d;
  }
  int64_t height = 0, weights = 0, rough = 0, spread = 0;
  int32_t first = 0;
  for (uint32_t i = 0; i < size; ++i) {
    if (ring[i] == kInfinity) continue;
    const int64_t d = squared_length(point_of(mesh, ring[i]), place);
    const int64_t w = quotient(nearest << 12, d);  // d >= nearest >= 1
    const int32_t z = mesh.z[ring[i]];
    if (weights == 0) first = z;
    weights += w;
    height += w * z;
    rough += w * roughness[ring[i]];
    spread += w * (z < first ? first - z : z - first);
  }
  if (weights == 0) return HeightPrediction{0, 0};
  HeightPrediction prediction;
  const int64_t twice = 2 * height + weights;  // floor(height / weights + 1/2)
  int64_t rounded = quotient(twice, 2 * weights);
  if (rounded * 2 * weights > twice) --rounded;
  prediction.height = static_cast<int32_t>(rounded);
  const uint32_t around = static_cast<uint32_t>(quotient(rough, weights));
  const uint32_t slope =
      static_cast<uint32_t>(log2_of(static_cast<uint64_t>(quotient(spread * 4, weights)) + 1)) /
      64u;
  prediction.roughness = (3 * around + slope) / 4;
  return prediction;
}

inline uint8_t roughness_of(uint32_t magnitude) {
  return static_cast<uint8_t>(log2_of(magnitude * 4u + 1u) / 64);
}

// Codes a height given its prediction. False if the stream's height does not fit 16 bits.
template <class Coder>
bool code_height(Coder& coder, HeightModel& model, const HeightPrediction& prediction, int16_t* z) {
  const int32_t difference = static_cast<int32_t>(*z) - prediction.height;
  uint32_t context = prediction.roughness / 3u;
  if (context >= kRoughnesses) context = kRoughnesses - 1;
  const uint32_t magnitude =
      code_magnitude(coder, model.exponent[context], model.mantissa, kMagnitudeBits,
                     static_cast<uint32_t>(difference < 0 ? -difference : difference));
  int32_t height = prediction.height;
  if (magnitude != 0) {
    const bool negative = code_bit(coder, model.negative, difference < 0);
    const int32_t step = static_cast<int32_t>(magnitude);
    height += negative ? -step : step;
  }
  if (height < -32768 || height > 32767) return false;
  *z = static_cast<int16_t>(height);
  return true;
}

}  // namespace microtin

#endif
