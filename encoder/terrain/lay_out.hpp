// SPDX-License-Identifier: MIT
// Laying a source on its lattice.
#ifndef MICROTIN_ENCODER_TERRAIN_LAY_OUT_HPP
#define MICROTIN_ENCODER_TERRAIN_LAY_OUT_HPP

#include <vector>

#include "encoder/layers.hpp"
#include "encoder/terrain/breaklines.hpp"
#include "encoder/terrain/lattice_choice.hpp"
#include "encoder/terrain/survey.hpp"

namespace microtin::terrain {

// Steps and displacements are in the units of LatticeOptions.
struct Laid {
  Placement placement;
  Survey survey;
  Decimal xy_step, z_step;
  Decimal xy_displacement;        // largest along x or y, by moving to the lattice
  Decimal z_displacement;         // largest by rounding to whole steps
  uint64_t merged = 0;            // points that came to a place already taken
  std::vector<Chain> breaklines;  // whose vertices are fixed samples of the survey
  LineRoom line_room;
  PositionTest is_shared;  // positions at which only vertices that are fixed already may be
};

// Whether a vertex of a chain may be at a position.
bool may_stand(const Laid& laid, Point place);

// Adds the pins of a vertex of a chain, but for one that is shared, which has its height.
void add_pins(const Laid& laid, const LatticeLine& line, const LineVertex& vertex,
              std::vector<Pin>& pins);

// Makes the vertices of all chains fixed samples. Throws Error as pin does.
void pin_chains(Laid& laid);

// A point goes to the nearest place, halves up. Points that share a place become one sample: with
// the middle of their lowest and highest height, or as the options' rule says. A void post that
// shares a place with a sample is dropped.
//
// Vertices of breaklines become samples, too, which are fixed.
//
// Throws Error if an explicit step does not fit, or if the bound cannot be kept: at places whose
// points differ by more than twice the bound, or where no whole z step lies within the bound.
Laid lay_out(const Source& source, const LatticeOptions& options);

// Lays out a source on a lattice that is chosen already, with the options that it was chosen by.
Laid lay_out(const Source& source, const Lattice& lattice, const LatticeOptions& options);

}  // namespace microtin::terrain

#endif
