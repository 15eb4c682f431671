// SPDX-License-Identifier: MIT
// Reconstruction as in the paper (its section 3): point by point, every tested triangle by its
// circle, nothing in the stream but the points.
//
// In place of the paper's dummy points, the vertex at infinity is the walk's root: the hull is
// exact. A test against a triangle at infinity counts like one against a circle.
#ifndef MICROTIN_TESTS_BENCH_PAPER_REBUILD_HPP
#define MICROTIN_TESTS_BENCH_PAPER_REBUILD_HPP

#include <functional>
#include <optional>

#include "tests/bench/paper/sequence.hpp"
#include "tests/bench/paper/walk.hpp"

namespace microtin::bench {

// How the triangles that an insertion destroys are found, from the first one on.
enum class Traversal {
  kAllNeighbours,  // each neighbour of a destroyed triangle is tested
  kUncertified,    // every neighbour, unless it is certified: it stays
  kSidedness       // every neighbour that sidedness tests do not decide
};

struct Method {
  std::optional<Walk> independent_sets;  // Algorithm 1 with this walk; else Algorithm 2
  Traversal traversal;
};

struct Tests {
  uint64_t in_circle = 0;
  uint64_t sidedness = 0;
  uint64_t destroyed = 0;   // triangles
  uint64_t violations = 0;  // of Lemma 1: certified triangles whose test says they are destroyed
};

// Calls phase_end, if there is one, with the mesh after each phase. Throws Error if points of a
// batch are left over at the end of its walk.
using PhaseEnd = std::function<void(const Mesh&)>;
Tests rebuild(const Sequence& sequence, const Method& method, const PhaseEnd& phase_end = {});

}  // namespace microtin::bench

#endif
