// SPDX-License-Identifier: MIT
// Heights anywhere on a stream's or a pack's surface, by the product's own query.
#ifndef MICROTIN_ENCODER_EXPORT_HEIGHT_SAMPLER_HPP
#define MICROTIN_ENCODER_EXPORT_HEIGHT_SAMPLER_HPP

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>

#include "encoder/layers.hpp"
#include "encoder/pack/file.hpp"

namespace microtin::exporting {

// A surface that can be asked. Lattice numbers; they count from the pack's first post.
struct SampledSurface {
  Placement placement;
  int64_t x_min = 0, y_min = 0, x_max = 0, y_max = 0;  // the box that holds it
  int32_t lowest = 0, highest = 0;                     // vertex
  // The height at a place, given with 8 fractional bits: with 16 fractional bits, nothing where
  // there is none. Quick anywhere, quickest near the place before.
  std::function<std::optional<int32_t>(int64_t x, int64_t y)> height_at;
};

// The mesh must outlive it.
SampledSurface sampled(const microtin_mesh* mesh);

// Decodes tiles when they are asked and keeps as many as two rows have, those asked last; fewer,
// but four, if they have more vertices together than `kept_vertices`. The pack must outlive it.
// Throws Error, also from height_at, as PackFile::tile does.
SampledSurface sampled(const PackFile& pack, uint64_t kept_vertices = kMaxVertices);

}  // namespace microtin::exporting

#endif
