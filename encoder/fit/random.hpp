// SPDX-License-Identifier: MIT
// Numbers that look random, the same on every machine.
#ifndef MICROTIN_ENCODER_FIT_RANDOM_HPP
#define MICROTIN_ENCODER_FIT_RANDOM_HPP

#include <cstddef>
#include <cstdint>

#include "encoder/layers.hpp"
#include "encoder/stream/spatial_order.hpp"

namespace microtin::fit {

// Sequences from different seeds have nothing in common.
class RandomNumbers {
 public:
  explicit RandomNumbers(uint64_t seed) : state_(scramble(seed)) {}

  // 0 .. limit - 1, where limit is below 2^32.
  std::size_t below(std::size_t limit) {
    return static_cast<std::size_t>((scramble(++state_) >> 32) * limit >> 32);
  }

 private:
  uint64_t state_;
};

}  // namespace microtin::fit

#endif
