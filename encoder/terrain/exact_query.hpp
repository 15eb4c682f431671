// SPDX-License-Identifier: MIT
// What a mesh holds: its vertices, and the height of its exact plane at a real place, which every
// host program answers. Devices answer by microtin_mesh_height_at, at the nearest 1/256 of a step.
#ifndef MICROTIN_ENCODER_TERRAIN_EXACT_QUERY_HPP
#define MICROTIN_ENCODER_TERRAIN_EXACT_QUERY_HPP

#include <array>
#include <cstdint>
#include <vector>

#include "encoder/exact/lattice_map.hpp"
#include "encoder/layers.hpp"
#include "microtin/microtin.h"
#include "shared/lattice.hpp"

namespace microtin::terrain {

inline Vertex vertex_of(const microtin_mesh* mesh, uint32_t v) {
  Vertex vertex{};
  microtin_mesh_vertex(mesh, v, &vertex.x, &vertex.y, &vertex.z);
  return vertex;
}

struct ExactAnswer {
  microtin_query_result kind;  // HEIGHT, OUTSIDE, IN_VOID; of a search that was limited, NOT_YET
  ExactHeight height;          // of HEIGHT
};

// The answer at a place of a verified mesh: without rounding, and the same from either side of an
// edge and in either tile at a border. The search begins at the triangle *hint, goes through at
// most `step_limit` triangles (0: without a limit) and leaves in *hint where it ended.
ExactAnswer exact_answer(const microtin_mesh* mesh, const RealPlace& place, uint32_t step_limit,
                         uint32_t* hint);

// The corners of the triangles with terrain that hold a place: one, or all around an edge or a
// vertex where the place lies. `hint` is where exact_answer ended for the place. O(d log d) for d
// triangles.
std::vector<std::array<Vertex, 3>> triangles_at(const microtin_mesh* mesh, const RealPlace& place,
                                                uint32_t hint);

}  // namespace microtin::terrain

#endif
