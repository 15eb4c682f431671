// SPDX-License-Identifier: MIT
// Queries on packs whose tiles are compact.
#include "decoder/pack_query.hpp"
#include "decoder/terrain_forms.hpp"

using namespace microtin;

microtin_query_result microtin_compact_pack_height_at(const microtin_pack* pack, int64_t x,
                                                      int64_t y, uint32_t* hint, int32_t* height) {
  return height_in_pack<RingForm>(*pack, x, y, hint, height);
}

microtin_query_result microtin_compact_pack_safe_heights_at(const microtin_pack* pack, int64_t x,
                                                            int64_t y, uint32_t* hint,
                                                            microtin_safe_heights* heights) {
  return safe_heights_in_pack<RingForm>(*pack, x, y, hint, heights);
}
