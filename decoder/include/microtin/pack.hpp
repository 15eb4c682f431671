// SPDX-License-Identifier: MIT
// The C++ face of pack.h: one object that holds the storage. C++14, freestanding.
#ifndef MICROTIN_PACK_HPP
#define MICROTIN_PACK_HPP

#include "microtin/microtin.hpp"
#include "microtin/pack.h"

namespace microtin {

// What both kinds of packs have in common. If the initialisation failed, status and load_with
// return the reason, and a program must call nothing else.
class PackFace {
 public:
  PackFace(const PackFace&) = delete;
  PackFace& operator=(const PackFace&) = delete;

  // The status of the initialisation.
  microtin_status status() const { return status_; }
  // Calls microtin_pack_reset.
  void reset() { microtin_pack_reset(pack_); }
  // Calls microtin_pack_bad_tile.
  microtin_status bad_tile(uint32_t i, uint32_t* tile, uint32_t* why) const {
    return microtin_pack_bad_tile(pack_, i, tile, why);
  }
  // Calls microtin_pack_clear_bad_tiles.
  void clear_bad_tiles() { microtin_pack_clear_bad_tiles(pack_); }
  // Calls microtin_pack_is_waiting.
  bool is_waiting() const { return microtin_pack_is_waiting(pack_) != 0; }
  // Calls microtin_pack_align_reads.
  microtin_status align_reads(uint32_t sector) { return microtin_pack_align_reads(pack_, sector); }
  // Calls microtin_pack_check_with for the tiles that a segment touches.
  microtin_status check_segment(const microtin_segment& segment, microtin_pack_check* check,
                                microtin_read read, void* context) {
    if (status_ != MICROTIN_STATUS_OK) return status_;
    return microtin_pack_check_with(pack_, &segment, 0, check, read, context);
  }
  // Calls microtin_pack_check_with for the tiles of a box.
  microtin_status check_box(const microtin_segment& diagonal, microtin_pack_check* check,
                            microtin_read read, void* context) {
    if (status_ != MICROTIN_STATUS_OK) return status_;
    return microtin_pack_check_with(pack_, &diagonal, 1, check, read, context);
  }
  // Calls microtin_pack_get_info.
  microtin_status get_info(microtin_pack_info* info) const {
    return microtin_pack_get_info(pack_, info);
  }

 protected:
  constexpr PackFace() = default;
  ~PackFace() = default;

  microtin_pack* pack_ = nullptr;
  microtin_status status_ = MICROTIN_STATUS_OK;  // of its initialisation
};

// A pack with Slots slots for tiles of up to Capacity vertices. pack.h has units, costs and the
// rules for interrupts.
template <uint32_t Slots, uint32_t Capacity>
class Pack : public PackFace {
  static_assert(Slots >= 1 && Slots <= 255, "1 to 255 slots");
  static_assert(Capacity >= 3, "a tile has at least three vertices");
  static_assert(Capacity <= MICROTIN_MAX_VERTICES, "more vertices than the index width reaches");

 public:
  Pack() { begin(); }
  // Leaves the object to `begin`; see DeferInit.
  constexpr explicit Pack(DeferInit) : storage_{} {}

  // Initialises the object and returns the status.
  microtin_status begin() {
    status_ = microtin_pack_init(storage_, sizeof storage_, Slots, Capacity, &pack_);
    return status_;
  }
  // Calls microtin_pack_load_with.
  microtin_status load_with(const microtin_segment& segment, microtin_read read, void* context,
                            uint32_t step_limit = 0) {
    if (status_ != MICROTIN_STATUS_OK) return status_;
    return microtin_pack_load_with(pack_, &segment, read, context, step_limit);
  }
  // Calls microtin_pack_search_path_with.
  microtin_status search_path_with(const microtin_path& path, microtin_path_search* search,
                                   microtin_read read, void* context, uint32_t flags = 0) {
    if (status_ != MICROTIN_STATUS_OK) return status_;
    return microtin_pack_search_path_with(pack_, &path, flags, search, read, context);
  }
  // Calls microtin_pack_safe_heights_at.
  microtin_query_result safe_heights_at(int64_t x, int64_t y, uint32_t* hint,
                                        microtin_safe_heights* heights) const {
    return microtin_pack_safe_heights_at(pack_, x, y, hint, heights);
  }
  // Calls microtin_pack_height_at.
  microtin_query_result height_at(int64_t x, int64_t y, uint32_t* hint, int32_t* height) const {
    return microtin_pack_height_at(pack_, x, y, hint, height);
  }
  // Calls microtin_pack_segment_extremes.
  microtin_query_result segment_extremes(const microtin_segment& segment,
                                         microtin_segment_extremes* extremes) const {
    return microtin_pack_segment_extremes(pack_, &segment, extremes);
  }
  // Calls microtin_pack_path_clearance.
  microtin_query_result path_clearance(const microtin_path& path,
                                       microtin_path_clearance* clearance,
                                       uint32_t flags = 0) const {
    return microtin_pack_path_clearance(pack_, &path, clearance, flags);
  }
  // Calls microtin_pack_profile_next.
  microtin_query_result profile_next(const microtin_segment& segment, microtin_segment_state* state,
                                     microtin_crossing* crossing) const {
    return microtin_pack_profile_next(pack_, &segment, state, crossing);
  }
  // Calls microtin_pack_gradient_at.
  microtin_query_result gradient_at(int64_t x, int64_t y, uint32_t* hint,
                                    microtin_gradient* gradient) const {
    return microtin_pack_gradient_at(pack_, x, y, hint, gradient);
  }
  // Calls microtin_pack_heights_at.
  microtin_query_result heights_at(const microtin_position* positions, uint32_t count,
                                   uint32_t* hint, int32_t* heights) const {
    return microtin_pack_heights_at(pack_, positions, count, hint, heights);
  }
  // Calls microtin_pack_grid_extremes.
  microtin_query_result grid_extremes(const microtin_grid_spec& grid,
                                      microtin_grid_extremes* extremes) const {
    return microtin_pack_grid_extremes(pack_, &grid, extremes);
  }
  // Calls microtin_pack_sample_grid.
  microtin_query_result sample_grid(const microtin_grid_spec& grid, int16_t* heights) const {
    return microtin_pack_sample_grid(pack_, &grid, heights);
  }

 private:
  alignas(MICROTIN_ALIGNMENT) unsigned char storage_[MICROTIN_PACK_BYTES(Slots, Capacity)];
};

}  // namespace microtin

#endif
