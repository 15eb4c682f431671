// SPDX-License-Identifier: MIT
// Comparing a decoded terrain with its source, by the product's own height query.
#ifndef MICROTIN_ENCODER_TERRAIN_VERIFY_HPP
#define MICROTIN_ENCODER_TERRAIN_VERIFY_HPP

#include <functional>
#include <optional>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::terrain {

// Errors are in the source's unit, rounded up to 9 decimals (their mean to nearest, from such):
// compared with a bound of at most 9 decimals, that changes nothing.
struct Verification {
  uint64_t posts = 0;           // with a height; covered and uncovered ones
  uint64_t covered = 0;         // where the terrain answers a height
  uint64_t uncovered = 0;       // where it does not
  uint64_t voids = 0;           // void posts
  uint64_t voids_answered = 0;  // void posts where the terrain answers a height
  Decimal max_error;
  Decimal max_below;  // how far the surface is below a height at most
  Decimal rms_error;
  Decimal mean_error;        // above 0: the terrain is too high
  bool within_bound = true;  // max_error is at most the bound, or there is none
};

// Told of every post with a height that the terrain answers: its place on the lattice (of a pack:
// of all of it), its height as the source's number, and how far the terrain is above it, in the
// source's unit.
using PostVisitor = std::function<void(int64_t x, int64_t y, int64_t z, double above)>;

// Evaluates every post or point, also those that share a place, at its place on the lattice, the
// nearest to where it lies.
Verification verify(const microtin_mesh* mesh, const Source& source,
                    const std::optional<Decimal>& bound, const PostVisitor& visit = {});

// Verifies a mesh whose lattice is placed otherwise than it states.
Verification verify(const microtin_mesh* mesh, const Placement& lattice, const Source& source,
                    const std::optional<Decimal>& bound, const PostVisitor& visit = {});

// The verification of several parts together; what lies in more than one counts for each.
Verification combine(const std::vector<Verification>& parts);

}  // namespace microtin::terrain

#endif
