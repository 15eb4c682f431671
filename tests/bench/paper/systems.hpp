// SPDX-License-Identifier: MIT
// The systems of the paper, and a check of its claims at run time.
#ifndef MICROTIN_TESTS_BENCH_PAPER_SYSTEMS_HPP
#define MICROTIN_TESTS_BENCH_PAPER_SYSTEMS_HPP

#include "tests/bench/paper/rebuild.hpp"

namespace microtin::bench {

struct System {
  const char* name;
  std::optional<Walk> independent_sets;  // Algorithm 1 with this walk; else Algorithm 2
  uint32_t degree;                       // most neighbours of a vertex that is removed
};

Order order_of(Triangulation& triangulation, const System& system);
Sequence sequence_of(const std::vector<Point>& points, const System& system);

// What a check found: no violation, and no phase after which the mesh is not the Delaunay
// triangulation that the same phase of the removal started from (Theorem 1).
struct Check {
  uint32_t phases = 0;
  uint32_t wrong_phases = 0;
  uint64_t violations = 0;    // of Lemma 1
  double least_fraction = 1;  // of the points that may be removed, in any phase
};
Check check(const std::vector<Point>& points, const System& system);

}  // namespace microtin::bench

#endif
