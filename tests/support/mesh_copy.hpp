// SPDX-License-Identifier: MIT
// A decoded mesh copied out through the public interface, for the checks of other tests.
#ifndef MICROTIN_TESTS_SUPPORT_MESH_COPY_HPP
#define MICROTIN_TESTS_SUPPORT_MESH_COPY_HPP

#include "microtin/microtin.h"
#include "tests/support/layers.hpp"
#include "tests/support/mesh_checks.hpp"
#include "tests/support/reference_delaunay.hpp"

namespace microtin::tests {

struct MeshCopy {
  explicit MeshCopy(const microtin_mesh* decoded)
      : place(microtin_mesh_vertex_count(decoded)),
        z(place.size()),
        origin(3 * microtin_mesh_triangle_count(decoded)),
        twin(origin.size(), kInfinity) {
    for (uint32_t v = 0; v < place.size(); ++v) {
      microtin_mesh_vertex(decoded, v, &place[v].x, &place[v].y, &z[v]);
    }
    for (uint32_t t = 0; t < origin.size() / 3; ++t)
      microtin_mesh_triangle(decoded, t, &origin[3 * t]);
    // The interface tells neighbours only; the shared edge is the one with the same ends.
    for (uint32_t h = 0; h < twin.size(); ++h) {
      const uint32_t other = 3 * microtin_mesh_neighbour(decoded, h / 3, h % 3);
      for (uint32_t g = other; g < other + 3; ++g) {
        if (origin[g] == origin[next_in_triangle(h)] && origin[next_in_triangle(g)] == origin[h]) {
          twin[h] = g;
        }
      }
    }
    mesh = Mesh{place.data(),
                z.data(),
                origin.data(),
                twin.data(),
                static_cast<Index>(place.size()),
                static_cast<Index>(origin.size() / 3)};
  }
  MeshCopy(const MeshCopy&) = delete;
  MeshCopy& operator=(const MeshCopy&) = delete;

  std::vector<Point> place;
  std::vector<int16_t> z;
  std::vector<Index> origin, twin;
  Mesh mesh{};
};

// Whether it is a triangulation, and the canonical one of its vertices.
inline bool is_sound(const MeshCopy& copy) {
  return mesh_fault(copy.mesh, copy.mesh.vertices).empty() &&
         is_reference_delaunay(copy.place, triangles_of(copy.mesh));
}

}  // namespace microtin::tests

#endif
