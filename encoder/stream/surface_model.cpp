// SPDX-License-Identifier: MIT
// Copies vertices and triangles out of a mesh.
#include "encoder/stream/surface_model.hpp"

#include "encoder/exact/mesh_vertex.hpp"

namespace microtin::stream {

SurfaceModel model_of(const microtin_mesh* mesh) {
  SurfaceModel model;
  microtin_mesh_axes(mesh, &model.placement.x, &model.placement.y, &model.placement.z);
  for (uint32_t v = 0; v < microtin_mesh_vertex_count(mesh); ++v) {
    const auto [x, y, z] = vertex_of(mesh, v);
    model.vertices.push_back({x, y, z});
  }
  for (uint32_t t = 0; t < microtin_mesh_triangle_count(mesh); ++t) {
    std::array<uint32_t, 3> corners{};
    if (microtin_mesh_triangle(mesh, t, corners.data()) == MICROTIN_TRIANGLE_REAL) {
      model.triangles.push_back(corners);
    }
  }
  return model;
}

}  // namespace microtin::stream
