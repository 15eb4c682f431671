// SPDX-License-Identifier: MIT
// A pack of either kind, whose slots hold meshes or compact terrains.
#ifndef MICROTIN_FUZZ_SUPPORT_PACK_SLOTS_HPP
#define MICROTIN_FUZZ_SUPPORT_PACK_SLOTS_HPP

#include <cstdint>
#include <vector>

#include "fuzz/support/expect.hpp"
#include "microtin/compact_pack.h"
#include "tests/support/limited_segment.hpp"

namespace microtin::tests {

// On the heap, of exactly the size that is asked for. Slots hold meshes, or compact terrains of
// this many bytes.
struct PackSlots {
  PackSlots(uint32_t slots, uint32_t capacity, uint32_t tile_bytes)
      : is_compact(tile_bytes != 0),
        memory(is_compact ? MICROTIN_COMPACT_PACK_BYTES(slots, capacity, tile_bytes)
                          : MICROTIN_PACK_BYTES(slots, capacity)) {
    const microtin_status status =
        is_compact ? microtin_compact_pack_init(memory.data(), memory.size(), slots, capacity,
                                                tile_bytes, &pack)
                   : microtin_pack_init(memory.data(), memory.size(), slots, capacity, &pack);
    EXPECT(status == MICROTIN_STATUS_OK);
  }

  microtin_status load_with(const microtin_segment& segment, microtin_read read, void* context,
                            uint32_t step_limit) const {
    return is_compact ? microtin_compact_pack_load_with(pack, &segment, read, context, step_limit)
                      : microtin_pack_load_with(pack, &segment, read, context, step_limit);
  }
  microtin_query_result height_at(int64_t x, int64_t y, uint32_t* hint, int32_t* height) const {
    return is_compact ? microtin_compact_pack_height_at(pack, x, y, hint, height)
                      : microtin_pack_height_at(pack, x, y, hint, height);
  }
  microtin_query_result segment_extremes(const microtin_segment& segment,
                                         microtin_segment_extremes* extremes) const {
    return is_compact ? microtin_compact_pack_segment_extremes(pack, &segment, extremes)
                      : microtin_pack_segment_extremes(pack, &segment, extremes);
  }
  microtin_query_result path_clearance(const microtin_path& path,
                                       microtin_path_clearance* clearance) const {
    return is_compact ? microtin_compact_pack_path_clearance(pack, &path, clearance, 0)
                      : microtin_pack_path_clearance(pack, &path, clearance, 0);
  }
  microtin_query_result profile_next(const microtin_segment& segment, microtin_segment_state* state,
                                     microtin_crossing* crossing) const {
    return is_compact ? microtin_compact_pack_profile_next(pack, &segment, state, crossing)
                      : microtin_pack_profile_next(pack, &segment, state, crossing);
  }
  microtin_query_result sample_grid(const microtin_grid_spec& block, int16_t* heights) const {
    return is_compact ? microtin_compact_pack_sample_grid(pack, &block, heights)
                      : microtin_pack_sample_grid(pack, &block, heights);
  }

  bool is_compact;
  std::vector<unsigned char> memory;
  microtin_pack* pack = nullptr;
};

// Queries on a pack have no step limit and, but for profiles, no state; see limited_segment.hpp.
inline uint32_t triangles_of(const PackSlots*) {
  return 1000;
}

inline Extremes limited_extremes(const PackSlots* slots, const microtin_segment& c, uint32_t,
                                 microtin_segment_state*) {
  Extremes told;
  told.answer = slots->segment_extremes(c, &told.found);
  return told;
}

inline microtin_query_result limited_clearance(const PackSlots* slots, const microtin_path& path,
                                               microtin_segment_state*,
                                               microtin_path_clearance* clearance, uint32_t) {
  return slots->path_clearance(path, clearance);
}

inline microtin_query_result next_crossing(const PackSlots* slots, const microtin_segment& c,
                                           microtin_segment_state* state,
                                           microtin_crossing* crossing, uint32_t) {
  return slots->profile_next(c, state, crossing);
}

}  // namespace microtin::tests

#endif
