// SPDX-License-Identifier: MIT
// Everything that is learned while coding, and where it starts.
#ifndef MICROTIN_SHARED_MODELS_HPP
#define MICROTIN_SHARED_MODELS_HPP

#include "shared/build_options.hpp"
#include "shared/height_coding.hpp"
#include "shared/hit_coding.hpp"
#include "shared/place_coding.hpp"
#include "shared/start_probabilities.hpp"

namespace microtin {

constexpr uint32_t kVoidContexts = 7;

struct Models {
  HitModel hit;
  PlaceModel place;
  HeightModel height;
  ExponentModel gap;
  AdaptiveBit is_void[kBuiltVoids ? kVoidContexts : 1];
};

template <class Model>
constexpr uint32_t bits_in() {
  constexpr size_t bit_bytes = sizeof(AdaptiveBit);
  return static_cast<uint32_t>(sizeof(Model) / bit_bytes);  // it has nothing else
}

constexpr uint32_t kStarts = bits_in<Models>();

// Adaptive bits in a row: how many there are in builds with everything, and of them, from the first
// on, in this build.
struct BitsInRow {
  uint32_t all, built;
};

constexpr BitsInRow kBitsInRow[] = {
    {bits_in<HitModel>(), bits_in<HitModel>()},
    {2 * kLevels * kCalibrationEntries, bits_in<decltype(PlaceModel::calibration)>()},
    {3 * kQuickContexts, bits_in<decltype(PlaceModel::quick)>()},
    {bits_in<HeightModel>(), bits_in<HeightModel>()},
    {bits_in<ExponentModel>(), bits_in<ExponentModel>()},
    {kVoidContexts, bits_in<decltype(Models::is_void)>()},
};

// The starts of the bits that this build has.
struct Starts {
  uint8_t start[kStarts];

  constexpr Starts() : start() {
    uint32_t from = 0, to = 0;
    for (const BitsInRow& row : kBitsInRow) {
      for (uint32_t i = 0; i < row.built; ++i) start[to++] = kStartTable[from + i];
      from += row.all;
    }
  }
};

constexpr Starts kBuiltStarts MICROTIN_IN_FLASH{};

inline uint32_t table_start(uint32_t i) {
  return read_table(kBuiltStarts.start + i);
}

inline void reset(Models& models) {
  uint16_t* to = reinterpret_cast<uint16_t*>(&models);
  for (uint32_t i = 0; i < kStarts; ++i) {
    const AdaptiveBit bit = adaptive_bit(table_start(i));
    *to++ = bit.fast;
    *to++ = bit.slow;
  }
}

}  // namespace microtin

#endif
