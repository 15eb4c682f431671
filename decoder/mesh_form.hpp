// SPDX-License-Identifier: MIT
// A mesh, as segments want to see terrains: tile_segment.hpp.
#ifndef MICROTIN_DECODER_MESH_FORM_HPP
#define MICROTIN_DECODER_MESH_FORM_HPP

#include "decoder/tile_segment.hpp"

namespace microtin {

class MeshForm {
 public:
  typedef MeshCursor Cursor;
  static constexpr bool kIsCompact = false;

  explicit MeshForm(const void* space) : m_(*static_cast<const microtin_mesh*>(space)) {}

  uint32_t triangles() const { return m_.mesh.triangles; }
  Point corner() const { return Point{0, 0}; }
  MeshCursor at(uint32_t t) const {
    const Index first = first_edge(static_cast<Index>(t));
    const Index* const v = m_.mesh.origin + first;
    const uint32_t i = v[0] == kInfinity ? 1u : v[1] == kInfinity ? 2u : 0u;
    return MeshCursor(m_, static_cast<Index>(first + i));
  }
  bool places(uint32_t t, Point* places) const {
    const Index* const v = m_.mesh.origin + first_edge(static_cast<Index>(t));
    if (is_ghost(v[0], v[1], v[2])) return false;
    for (int i = 0; i < 3; ++i) places[i] = point_of(m_.mesh, v[i]);
    return true;
  }
  microtin_query_result height_at(LocalPoint p, uint32_t step_limit, uint32_t* hint,
                                  int32_t* height) const {
    return microtin_mesh_height_at(&m_, p.x, p.y, hint, height, 0, step_limit);
  }

 private:
  const microtin_mesh& m_;
};

}  // namespace microtin

#endif
