// SPDX-License-Identifier: MIT
// Queries on packs whose tiles are meshes, and what headers say.
#include "decoder/pack_query.hpp"

#include "decoder/axis.hpp"

namespace microtin {
namespace {

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
  microtin_answer height_at(LocalPoint p, uint32_t* hint, int32_t* height) const {
    return microtin_height_at(&m_, p.x, p.y, 0, hint, height);
  }

 private:
  const microtin_mesh& m_;
};

}  // namespace
}  // namespace microtin

using namespace microtin;

int microtin_pack_header(const microtin_pack* pack, microtin_pack_info* info) {
  if (!pack->has_header) return 0;
  const PackHeader& header = pack->header;
  info->x_max = header.grid.x_max;
  info->y_max = header.grid.y_max;
  info->tile_width = header.grid.width;
  info->tile_height = header.grid.height;
  info->most_vertices = header.most_vertices;
  info->compact_bytes = header.compact_bytes;
  info->lowest = header.lowest;
  info->highest = header.highest;
  info->x = pack->axis[0];
  info->y = pack->axis[1];
  info->z = pack->axis[2];
  return 1;
}

int microtin_pack_to_lattice(const microtin_axis* axis, uint32_t most, int64_t value,
                             uint32_t per_unit, int64_t* lattice) {
  if (axis->numerator >> 30 != 0 || most > kPackExtentMost) return 0;  // their product: < 2^61
  const int64_t found = half_steps(*axis, most, value, per_unit);
  if (found < 0) return 0;
  *lattice = rounded_steps(found);
  return 1;
}

microtin_answer microtin_pack_height_at(const microtin_pack* pack, int64_t x, int64_t y,
                                        uint32_t* hint, int32_t* height) {
  return height_in_pack<MeshForm>(*pack, x, y, hint, height);
}

microtin_answer microtin_pack_highest(const microtin_pack* pack, const microtin_course* course,
                                      int32_t* height) {
  return highest_in_pack<MeshForm>(*pack, *course, height);
}

microtin_answer microtin_pack_fill(const microtin_pack* pack, const microtin_block* block,
                                   int16_t* heights) {
  return fill_from_pack<MeshForm>(*pack, *block, heights);
}
