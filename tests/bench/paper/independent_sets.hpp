// SPDX-License-Identifier: MIT
// The order of the paper's Algorithm 1: J. Snoeyink, M. van Kreveld, "Linear-time reconstruction of
// Delaunay triangulations with applications" (ESA 1997), as the paper changed it.
#ifndef MICROTIN_TESTS_BENCH_PAPER_INDEPENDENT_SETS_HPP
#define MICROTIN_TESTS_BENCH_PAPER_INDEPENDENT_SETS_HPP

#include "encoder/stream/order.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/paper/walk.hpp"

namespace microtin::bench {

// Empties `triangulation` down to a triangle. Each phase removes an independent set of vertices
// with at most `degree` neighbours, chosen greedily, those with the fewest first. A batch is sorted
// by the time at which the walk over the triangles that are left meets the first that the vertex
// destroys.
Order independent_set_order(Triangulation& triangulation, uint32_t degree, Walk walk);

}  // namespace microtin::bench

#endif
