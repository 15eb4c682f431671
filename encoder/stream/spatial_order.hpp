// SPDX-License-Identifier: MIT
// The order in which points are inserted so that a triangulation of them is quick to build: random
// rounds, and along the Hilbert curve within each.
#ifndef MICROTIN_ENCODER_STREAM_SPATIAL_ORDER_HPP
#define MICROTIN_ENCODER_STREAM_SPATIAL_ORDER_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/layers.hpp"
#include "shared/mesh.hpp"

namespace microtin::stream {

// SplitMix64: different for different numbers, each bit as good as a coin.
inline uint64_t scramble(uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  return x ^ x >> 31;
}

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

// Numbers of the points, each once, in rounds of growing size (a biased randomized insertion order:
// Amenta, Choi and Rote, "Incremental constructions con BRIO") and along a Hilbert curve within
// each. The places alone decide, so the order of the input does not matter. Throws Error if two
// points share a place.
std::vector<Index> insertion_order(const std::vector<Point>& points);

// Brings the numbers of three points that form a counter-clockwise triangle to the front of an
// order. turn_of(a, b, c) is positive if those points turn to the left, 0 if they lie on a line.
// Throws Error if there are none.
template <class Number, class TurnOf>
void start_with_triangle(std::vector<Number>& order, const TurnOf& turn_of) {
  for (std::size_t i = 2; i < order.size(); ++i) {
    const int64_t turn = turn_of(order[0], order[1], order[i]);
    if (turn == 0) continue;
    std::swap(order[2], order[i]);
    if (turn < 0) std::swap(order[0], order[1]);
    return;
  }
  throw Error("all points lie on one line: there is no triangle");
}

}  // namespace microtin::stream

#endif
