// SPDX-License-Identifier: MIT
// Points where they truly lie, beside the places of the lattice that they moved to.
#ifndef MICROTIN_ENCODER_TERRAIN_TRUE_PLACES_HPP
#define MICROTIN_ENCODER_TERRAIN_TRUE_PLACES_HPP

#include <cstdint>
#include <functional>
#include <optional>

#include "encoder/layers.hpp"
#include "encoder/terrain/exact_query.hpp"
#include "encoder/terrain/source.hpp"
#include "encoder/terrain/verify.hpp"

namespace microtin::terrain {

// The exact height at a place of the lattice.
using HeightQuery = std::function<ExactAnswer(const RealPlace& place)>;

// Told of each point's place on the lattice, where it truly lies, and how far the surface is above.
using TruePlaceVisitor =
    std::function<void(const RealPlace& nearest, const RealPlace& exact, double above)>;

// True if a lattice does not hold all points where they lie.
bool moves_points(const Placement& lattice, const PointCloud& cloud);

// As verify, but compares with the exact plane at each point's true place; where that is outside
// the terrain, at its place on the lattice. Asks from north to south.
Verification verify_at_true_places(const HeightQuery& height_at, const Placement& lattice,
                                   const PointCloud& cloud, const std::optional<Decimal>& bound,
                                   const TruePlaceVisitor& visit = {});

}  // namespace microtin::terrain

#endif
