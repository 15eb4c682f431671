// SPDX-License-Identifier: MIT
// A decoded terrain as vertices and triangles: what is exported, drawn and put together of tiles.
#ifndef MICROTIN_ENCODER_STREAM_SURFACE_MODEL_HPP
#define MICROTIN_ENCODER_STREAM_SURFACE_MODEL_HPP

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "encoder/exact/metadata.hpp"
#include "encoder/layers.hpp"
#include "microtin/microtin.h"

namespace microtin::stream {

// A surface in global lattice coordinates. Triangles are counter-clockwise from above, without void
// ones.
struct SurfaceModel {
  Placement placement;
  Unit horizontal_unit = Unit::kUnknown, vertical_unit = Unit::kUnknown;
  std::string system;  // of coordinates, in one line; empty: not known
  std::vector<std::array<int64_t, 3>> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
};

// Vertices keep their numbers.
SurfaceModel model_of(const microtin_mesh* mesh);

}  // namespace microtin::stream

#endif
