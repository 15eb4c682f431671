// SPDX-License-Identifier: MIT
// The order in which vertices are sent.
#ifndef MICROTIN_ENCODER_STREAM_ORDER_HPP
#define MICROTIN_ENCODER_STREAM_ORDER_HPP

#include <array>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/stream/triangulation.hpp"

namespace microtin::stream {

struct Order {
  std::array<Index, 3> seed;                // counter-clockwise, the first one the smallest
  std::vector<std::vector<Index>> batches;  // coarsest first, each in the order of insertion
};

// Empties `triangulation` down to the seed, phase by phase: in reverse breadth-first order every
// vertex whose degree is at most `degree` when its turn comes is removed (Sohler, section 2).
// Linear.
Order breadth_first_order(Triangulation& triangulation, uint32_t degree);

}  // namespace microtin::stream

#endif
