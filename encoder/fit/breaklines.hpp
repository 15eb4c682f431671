// SPDX-License-Identifier: MIT
// Breaklines as edges of a Delaunay triangulation, by vertices that are added.
#ifndef MICROTIN_ENCODER_FIT_BREAKLINES_HPP
#define MICROTIN_ENCODER_FIT_BREAKLINES_HPP

#include <cstdint>

#include "encoder/layers.hpp"
#include "encoder/terrain/lay_out.hpp"
#include "encoder/terrain/survey.hpp"

namespace microtin::fit {

struct BreaklineCost {
  uint32_t on_lines = 0;     // vertices of chains
  int64_t added = 0;         // vertices more than before
  uint32_t unit_pieces = 0;  // edges that splitting left with the length of a lattice step
};

// Makes each piece of each chain an edge. A piece that is missing has a vertex in the circle around
// it. Such vertices are removed where all bounds hold without them; else the piece is split at the
// lattice position nearest to where that vertex projects on the line. Posts that miss their bounds
// then become vertices. It ends at the latest where pieces are edges of length 1 of the lattice,
// since no other lattice position lies in the circle around one. The chains and the survey of
// `laid` have all vertices then. Throws Error naming a place if the search for splits takes longer
// than that.
BreaklineCost keep_breaklines(Laid& laid, Tin& tin);

}  // namespace microtin::fit

#endif
