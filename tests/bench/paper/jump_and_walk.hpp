// SPDX-License-Identifier: MIT
// Mücke, Saias and Zhu: "Fast randomized point location without preprocessing in two- and
// three-dimensional Delaunay triangulations" (1996).
#ifndef MICROTIN_TESTS_BENCH_PAPER_JUMP_AND_WALK_HPP
#define MICROTIN_TESTS_BENCH_PAPER_JUMP_AND_WALK_HPP

#include <vector>

#include "shared/lattice.hpp"

namespace microtin::bench {

// Triangulates the points in their order, of which the first three must not lie on one line: jumps
// to the nearest of n^(1/3) random vertices and walks from there. Returns the number of in-circle
// tests.
uint64_t jump_and_walk(const std::vector<Point>& points, uint64_t seed);

}  // namespace microtin::bench

#endif
