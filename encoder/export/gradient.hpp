// SPDX-License-Identifier: MIT
// The slope of a stream's or a pack's surface at a real place.
#ifndef MICROTIN_ENCODER_EXPORT_GRADIENT_HPP
#define MICROTIN_ENCODER_EXPORT_GRADIENT_HPP

#include <cstdint>
#include <optional>

#include "encoder/export/height_sampler.hpp"
#include "encoder/layers.hpp"

namespace microtin::exporting {

// Where the last search ended; the next one is quick if it is near.
struct GradientSearch {
  const microtin_mesh* mesh = nullptr;
  uint32_t hint = 0;
};

// z steps for each lattice step.
struct LatticeGradient {
  double x, y;
};

// The gradient of the exact triangle at a place. On an edge or a vertex it is that of the triangle
// that devices choose: see microtin_mesh_gradient_at. Nothing if the place has no height, or only
// as a vertex among voids. Throws Error as the surface's height_at does.
std::optional<LatticeGradient> gradient_at(const SampledSurface& surface, const RealPlace& place,
                                           GradientSearch& search);

}  // namespace microtin::exporting

#endif
