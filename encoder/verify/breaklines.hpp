// SPDX-License-Identifier: MIT
// Whether lines are chains of edges of a decoded terrain.
#ifndef MICROTIN_ENCODER_VERIFY_BREAKLINES_HPP
#define MICROTIN_ENCODER_VERIFY_BREAKLINES_HPP

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/terrain/breaklines.hpp"
#include "encoder/terrain/line_class.hpp"
#include "microtin/microtin.h"

namespace microtin::verifying {

// The edges along one part of a line.
struct FoundChain {
  uint32_t line;                   // its number in the file
  std::vector<uint32_t> vertices;  // each with an edge to the next one
};

struct FoundBreaklines {
  std::set<uint32_t> lines;  // of the file, at least partly over the terrain
  uint64_t pieces = 0;       // edges along them
  double max_shift = 0;      // between a line and its edges, in lattice steps
  double max_error = 0;      // between their heights, in z steps; of lines that have heights
  std::vector<FoundChain> chains;
  std::optional<std::string> missing;      // which line has no such chain, and where
  std::optional<std::string> wrong_marks;  // what compare_marks found in a stream, if it was called
};

// What was found in all parts of a terrain.
void add(const FoundBreaklines& part, FoundBreaklines& all);

// Looks along each line for edges that follow it from its beginning to its end, at most kMostShift
// lattice steps away, and at heights within the room. Without room heights are only measured.
// O(triangles + vertices near the lines * their degrees).
FoundBreaklines find_breaklines(const microtin_mesh* mesh, const std::vector<LatticeLine>& lines,
                                const std::optional<LineRoom>& room, const Placement& lattice);

// Compares the marks of a mesh's edges with lines. `classes` has the class of each line by its
// number. Each marked edge must follow a line of its class. Along each line find_breaklines must
// find edges with the class of this line, or with that of an earlier line that they follow, too.
// Returns what breaks this rule, and where, or nothing. Takes as long as find_breaklines.
std::optional<std::string> compare_marks(const microtin_mesh* mesh,
                                         const std::vector<MarkedLine>& marks,
                                         const std::vector<LatticeLine>& lines,
                                         const std::vector<LineClass>& classes,
                                         const std::optional<LineRoom>& room,
                                         const Placement& lattice);

}  // namespace microtin::verifying

#endif
