// SPDX-License-Identifier: MIT
// Numbers that look random, from numbers that do not.
#ifndef MICROTIN_ENCODER_BASE_SCRAMBLE_HPP
#define MICROTIN_ENCODER_BASE_SCRAMBLE_HPP

#include <cstdint>

#include "encoder/layers.hpp"

namespace microtin::base {

// SplitMix64: different for different numbers, each bit as good as a coin.
inline uint64_t scramble(uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  return x ^ x >> 31;
}

}  // namespace microtin::base

#endif
