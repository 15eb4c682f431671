// SPDX-License-Identifier: MIT
// What a client receives: points in a good order, cut into batches.
#ifndef MICROTIN_TESTS_BENCH_PAPER_SEQUENCE_HPP
#define MICROTIN_TESTS_BENCH_PAPER_SEQUENCE_HPP

#include <cstdint>
#include <vector>

#include "encoder/stream/order.hpp"
#include "tests/bench/layers.hpp"

namespace microtin::bench {

struct Sequence {
  std::vector<Point> points;  // the first three are a counter-clockwise triangle
  std::vector<uint32_t> batches;
};

inline Sequence sequence_of(const Order& order, const Mesh& mesh) {
  Sequence sequence;
  sequence.points.reserve(mesh.vertices);
  for (const Index v : order.seed) sequence.points.push_back(point_of(mesh, v));
  for (const std::vector<Index>& batch : order.batches) {
    for (const Index v : batch) sequence.points.push_back(point_of(mesh, v));
    sequence.batches.push_back(static_cast<uint32_t>(batch.size()));
  }
  return sequence;
}

}  // namespace microtin::bench

#endif
