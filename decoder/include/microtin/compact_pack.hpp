// SPDX-License-Identifier: MIT
// The C++ face of compact_pack.h: one object that holds the storage. C++14, freestanding.
#ifndef MICROTIN_COMPACT_PACK_HPP
#define MICROTIN_COMPACT_PACK_HPP

#include "microtin/compact_pack.h"
#include "microtin/pack.hpp"

namespace microtin {

// A pack that decodes tiles of up to Capacity vertices and keeps Slots of them in TileBytes each.
// See compact_pack.h for what these may be, pack.h for units, costs and who may interrupt whom.
template <uint32_t Slots, uint32_t Capacity, uint32_t TileBytes = MICROTIN_COMPACT_BYTES(Capacity)>
class CompactPack : public PackFace {
  static_assert(Slots >= 1 && Slots <= 255, "1 to 255 slots");
  static_assert(Capacity >= 3, "a tile has at least three vertices");
  static_assert(Capacity <= MICROTIN_MAX_VERTICES, "more vertices than the index width reaches");

 public:
  CompactPack() { begin(); }
  constexpr explicit CompactPack(Later) : storage_{} {}

  microtin_status begin() {
    status_ =
        microtin_compact_pack_init(storage_, sizeof storage_, Slots, Capacity, TileBytes, &pack_);
    return status_;
  }
  microtin_status service(const microtin_segment& course, uint32_t step_limit, microtin_read read,
                          void* context) {
    if (status_ != MICROTIN_STATUS_OK) return status_;
    return microtin_compact_pack_load_with(pack_, &course, step_limit, read, context);
  }
  microtin_query_result height_at(int64_t x, int64_t y, uint32_t* hint, int32_t* height) const {
    return microtin_compact_pack_height_at(pack_, x, y, hint, height);
  }
  microtin_query_result highest(const microtin_segment& course, int32_t* height) const {
    return microtin_compact_pack_segment_max(pack_, &course, height);
  }
  microtin_query_result fill(const microtin_grid_spec& block, int16_t* heights) const {
    return microtin_compact_pack_sample_grid(pack_, &block, heights);
  }

 private:
  alignas(MICROTIN_ALIGNMENT) unsigned char storage_[MICROTIN_COMPACT_PACK_BYTES(Slots, Capacity,
                                                                                 TileBytes)];
};

}  // namespace microtin

#endif
