// SPDX-License-Identifier: MIT
// Points where they truly lie, beside the places of the lattice that they moved to.
#ifndef MICROTIN_ENCODER_TERRAIN_TRUE_PLACES_HPP
#define MICROTIN_ENCODER_TERRAIN_TRUE_PLACES_HPP

#include <cstdint>
#include <functional>
#include <optional>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"
#include "encoder/terrain/verify.hpp"

namespace microtin::terrain {

// The height at a place of the lattice with 8 fractional bits, as a height query answers it;
// nothing where there is none.
using HeightQuery = std::function<std::optional<int32_t>(int64_t x, int64_t y)>;

// With 8 fractional bits.
struct FinePlace {
  int64_t x, y;
};

// Told of each point's place on the lattice, where it truly lies, and how far the surface is above.
using TruePlaceVisitor = std::function<void(FinePlace nearest, FinePlace exact, double above)>;

// True if a lattice does not hold all points where they lie.
bool moves_points(const Placement& lattice, const PointCloud& cloud);

// As verify, but asks at each point's true place, to 1/256 of a step; where that is outside the
// terrain, at its place on the lattice. Asks from north to south.
Verification verify_at_true_places(const HeightQuery& height_at, const Placement& lattice,
                                   const PointCloud& cloud, const std::optional<Decimal>& bound,
                                   const TruePlaceVisitor& visit = {});

}  // namespace microtin::terrain

#endif
