// SPDX-License-Identifier: MIT
// The Hilbert curve: an order of places in which neighbours are close to one another.
#ifndef MICROTIN_ENCODER_STREAM_HILBERT_HPP
#define MICROTIN_ENCODER_STREAM_HILBERT_HPP

#include <array>
#include <cstdint>

#include "encoder/layers.hpp"

namespace microtin::stream {

// A step of the curve takes four bits of x and y. Each square of the curve is the first one, its
// axes swapped (bit 0 of the orientation), reversed (bit 1), or both.
struct HilbertStep {
  uint8_t position;     // among the 16 x 16 squares
  uint8_t orientation;  // of what lies in the square
};
using HilbertSteps = std::array<HilbertStep, 4 * 256>;  // by orientation, x, y

constexpr HilbertStep hilbert_step(uint32_t orientation, uint32_t x, uint32_t y) {
  uint32_t position = 0;
  for (uint32_t side = 8; side != 0; side >>= 1) {
    const bool swapped = (orientation & 1) != 0, reversed = (orientation & 2) != 0;
    const bool right = (((swapped ? y : x) & side) != 0) != reversed;
    const bool upper = (((swapped ? x : y) & side) != 0) != reversed;
    position = position << 2 | ((right ? 3u : 0u) ^ (upper ? 1u : 0u));
    if (!upper) orientation ^= right ? 3u : 1u;
  }
  return {static_cast<uint8_t>(position), static_cast<uint8_t>(orientation)};
}

constexpr HilbertSteps hilbert_steps() {
  HilbertSteps steps{};
  for (uint32_t i = 0; i < steps.size(); ++i) {
    steps[i] = hilbert_step(i >> 8, i >> 4 & 15u, i & 15u);
  }
  return steps;
}

constexpr HilbertSteps kHilbertSteps = hilbert_steps();

// The position of a place on the curve through the places with coordinates of kBits bits.
template <int kBits>
uint64_t hilbert_position(uint32_t x, uint32_t y) {
  constexpr int kSteps = (kBits + 3) / 4;
  uint64_t position = 0;
  uint32_t orientation = (4 * kSteps - kBits) & 1;  // each leading 0 swaps the axes once
  for (int shift = 4 * (kSteps - 1); shift >= 0; shift -= 4) {
    const HilbertStep step =
        kHilbertSteps[orientation << 8 | (x >> shift & 15) << 4 | (y >> shift & 15)];
    position = position << 8 | step.position;
    orientation = step.orientation;
  }
  return position;
}

}  // namespace microtin::stream

#endif
