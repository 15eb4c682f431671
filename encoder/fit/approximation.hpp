// SPDX-License-Identifier: MIT
// A source in few bytes, never wrong by more than asked for.
#ifndef MICROTIN_ENCODER_FIT_APPROXIMATION_HPP
#define MICROTIN_ENCODER_FIT_APPROXIMATION_HPP

#include "encoder/fit/simplify.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/lay_out.hpp"

namespace microtin::fit {

struct Approximation {
  Laid laid;
  Tin tin;
};

// Lays the source out and simplifies it. If there is a bound but no z step, the step is the one of
// a few parts of the bound, or of the source's own step, that makes a quick search's stream
// smallest. Throws Error as lay_out and simplify do.
Approximation approximate(const Source& source, const LatticeOptions& lattice,
                          const SimplifyOptions& options);

// Runs `rounds` more rounds of the same search.
void search_further(Approximation& found, uint32_t rounds, const SimplifyOptions& options);

}  // namespace microtin::fit

#endif
