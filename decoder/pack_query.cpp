// SPDX-License-Identifier: MIT
// Queries on packs whose tiles are meshes, and what headers say.
#include "decoder/pack_query.hpp"

#include "decoder/axis.hpp"
#include "decoder/terrain_forms.hpp"

using namespace microtin;

microtin_status microtin_pack_get_info(const microtin_pack* pack, microtin_pack_info* info) {
  if (!has_header(*pack)) return MICROTIN_STATUS_NEED_INPUT;
  const PackHeader& header = pack->header;
  info->x_max = header.grid.x_max;
  info->y_max = header.grid.y_max;
  info->tile_width = header.grid.width;
  info->tile_height = header.grid.height;
  info->max_tile_vertices = header.most_vertices;
  info->max_compact_bytes = header.compact_bytes;
  info->lowest = header.lowest;
  info->highest = header.highest;
  info->below = header.below;
  info->above = header.above;
  put_axes(pack->axis, info);
  return MICROTIN_STATUS_OK;
}

microtin_status microtin_pack_axis_to_lattice(const microtin_axis* axis, uint32_t most,
                                              int64_t value, uint32_t per_unit, int64_t* lattice) {
  if (axis->numerator >> 30 != 0 || most > kPackExtentMost) {  // their product: < 2^61
    return MICROTIN_STATUS_OUT_OF_RANGE;
  }
  const int64_t found = half_steps(*axis, most, value, per_unit);
  if (found < 0) return MICROTIN_STATUS_OUT_OF_RANGE;
  *lattice = rounded_steps(found);
  return MICROTIN_STATUS_OK;
}

microtin_query_result microtin_pack_height_at(const microtin_pack* pack, int64_t x, int64_t y,
                                              uint32_t* hint, int32_t* height) {
  return height_in_pack<MeshForm>(*pack, x, y, hint, height);
}

microtin_query_result microtin_pack_safe_heights_at(const microtin_pack* pack, int64_t x, int64_t y,
                                                    uint32_t* hint,
                                                    microtin_safe_heights* heights) {
  return safe_heights_in_pack<MeshForm>(*pack, x, y, hint, heights);
}
