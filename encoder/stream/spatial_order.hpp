// SPDX-License-Identifier: MIT
// The order in which points are inserted so that a triangulation of them is quick to build.
#ifndef MICROTIN_ENCODER_STREAM_SPATIAL_ORDER_HPP
#define MICROTIN_ENCODER_STREAM_SPATIAL_ORDER_HPP

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/layers.hpp"
#include "shared/mesh.hpp"

namespace microtin::stream {

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
