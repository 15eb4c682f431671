// SPDX-License-Identifier: MIT
// Everything that is learned while coding, and where it starts.
#ifndef MICROTIN_SHARED_MODELS_HPP
#define MICROTIN_SHARED_MODELS_HPP

#include "shared/format.hpp"
#include "shared/height_coding.hpp"
#include "shared/hit_coding.hpp"
#include "shared/place_coding.hpp"
#include "shared/start_probabilities.hpp"

namespace microtin {

struct Models {
  HitModel hit;
  PlaceModel place;
  HeightModel height;
  ExponentModel gap;
  AdaptiveBit is_void[kBuiltVoids ? 7 : 1];
};

constexpr uint32_t kStarts = sizeof kStartTable;

static_assert(sizeof(Models) == kStarts * sizeof(AdaptiveBit), "nothing but adaptive bits");

inline uint32_t table_start(uint32_t i) {
  return read_table(kStartTable + i);
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
