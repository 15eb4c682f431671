// SPDX-License-Identifier: MIT
// A decoded mesh's vertex as one value.
#ifndef MICROTIN_ENCODER_EXACT_MESH_VERTEX_HPP
#define MICROTIN_ENCODER_EXACT_MESH_VERTEX_HPP

#include <cstdint>

#include "encoder/layers.hpp"
#include "microtin/microtin.h"
#include "shared/lattice.hpp"

namespace microtin::exact {

inline Vertex vertex_of(const microtin_mesh* mesh, uint32_t v) {
  Vertex vertex{};
  microtin_mesh_vertex(mesh, v, &vertex.x, &vertex.y, &vertex.z);
  return vertex;
}

}  // namespace microtin::exact

#endif
