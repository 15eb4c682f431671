// SPDX-License-Identifier: MIT
// The choice of the vertices that represent a source: how it is laid out, and which samples count.
#ifndef MICROTIN_ENCODER_FIT_SIMPLIFY_HPP
#define MICROTIN_ENCODER_FIT_SIMPLIFY_HPP

#include <cstddef>
#include <cstdint>

#include "encoder/base/work.hpp"
#include "encoder/layers.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/terrain/lay_out.hpp"
#include "encoder/terrain/survey.hpp"

namespace microtin::fit {

// How long to look for fewer vertices within a bound.
enum class Search : uint8_t {
  kGreedy,  // insertion only
  kTrial,   // to compare steps of height: one round, and heights as they come
  kFast,    // some 18 % more bytes than normal
  kNormal,
  kLong,  // for one part of a terrain that must become smaller: some 5 % fewer vertices
  kBest   // some 7 % fewer bytes than normal
};

struct SimplifyOptions {
  bool bounded = false;       // the surface must lie in lowest .. highest at every sample
  uint32_t max_vertices = 0;  // if not 0: no more than that, except where hull and voids need them
  Search search = Search::kNormal;
  bool few_vertices = false;  // rather than few bytes
  bool centred = true;        // vertices move for the sake of the mean error, too
  std::size_t threads = 1;    // that the search uses; what it finds does not depend on them
  Effort effort;              // with which the result will be encoded
  Progress progress;          // of the search
};

// Without options every sample becomes a vertex. With one of them, as few as greedy insertion of
// the worst sample finds: until the bound holds or, if none is requested, until the error is 0 or
// max_vertices is reached. If a bound alone is requested, vertices are then removed and moved and
// their heights chosen, off the source if need be, so that they are as few and as cheap to code as
// `search` has time to find.
//
// The samples that the survey has as fixed are vertices in any case. Every sample is a vertex, lies
// in a triangle that is not void, or on an edge of one; every void post within the hull lies in a
// void triangle and on no edge of another. Throws Error if the samples form no triangle.
Tin simplify(const Survey& survey, const SimplifyOptions& options);

// Goes on where a search for the same survey and bound ended: by this many rounds, in each of which
// every vertex is tried. What it returns takes no more bytes.
Tin search_on(const Survey& survey, const Tin& tin, uint32_t rounds,
              const SimplifyOptions& options);

// A surface of a survey with other bounds, which may be narrower: with more vertices where it takes
// them to keep these.
Tin mended(const Survey& survey, const Tin& tin);

// How many of them simplify does.
uint32_t rounds_of(Search search);

struct Approximation {
  Laid laid;
  Tin tin;
};

// A z step near `hundredths` hundredths of the sum of the bound and the source's own step. It is
// the own step times 1, 2, 4, 8, or a larger even number. With such a step the surface is a
// multiple of the own step at more posts, above all in the middle of an edge. A multiple may be as
// far off as the bound; numbers between multiples must be nearer.
Decimal step_near(Decimal own, Decimal bound, int hundredths);

// Hundredths of the bound for a step that also suits breaklines and bounds between posts.
constexpr int kFineStep = 40;

// Lays the source out and simplifies it. If there is a bound but no z step, the step is the one of
// a few near parts of the bound that makes a quick search's stream smallest. Throws Error as
// lay_out and simplify do.
Approximation approximate(const Source& source, const LatticeOptions& lattice,
                          const SimplifyOptions& options);

// Runs `rounds` more rounds of the same search.
void search_further(Approximation& found, uint32_t rounds, const SimplifyOptions& options);

}  // namespace microtin::fit

#endif
