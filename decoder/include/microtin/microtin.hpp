// SPDX-License-Identifier: MIT
// The C++ face of microtin.h: one object that holds the storage. C++14, freestanding.
#ifndef MICROTIN_MICROTIN_HPP
#define MICROTIN_MICROTIN_HPP

#include "microtin/compact.h"
#include "microtin/segment.h"

namespace microtin {

// Makes the constructor of a static object do nothing, `static Terrain<5000> terrain(defer_init)`:
// the object lies in zeroed memory, and the program must call its begin before all else. Buckets
// and compact terrains never need it.
struct DeferInit {};
// NOLINTNEXTLINE(readability-identifier-naming): part of the interface
constexpr DeferInit defer_init = {};

// A terrain of up to Capacity vertices. Queries live here; see microtin.h for units and costs.
// Should its initialisation fail, status tells why, as does feeding its decoder, and nothing else
// may be called.
template <uint32_t Capacity>
class Terrain {
  static_assert(Capacity >= 3, "a terrain has at least three vertices");
  static_assert(Capacity <= MICROTIN_MAX_VERTICES, "more vertices than the index width reaches");

 public:
  Terrain() { begin(); }
  // Leaves the object to `begin`; see DeferInit.
  constexpr explicit Terrain(DeferInit) : storage_{} {}
  Terrain(const Terrain&) = delete;
  Terrain& operator=(const Terrain&) = delete;

  // Initialises the object and returns the status.
  microtin_status begin() {
    status_ = microtin_mesh_init(storage_, sizeof storage_, &mesh_);
    return status_;
  }
  // The status of the initialisation.
  microtin_status status() const { return status_; }
  // The mesh, for the functions of microtin.h.
  microtin_mesh* mesh() { return mesh_; }
  // The mesh, for the functions of microtin.h.
  const microtin_mesh* mesh() const { return mesh_; }

  // Calls microtin_mesh_vertex_count.
  uint32_t vertices() const { return microtin_mesh_vertex_count(mesh_); }
  // Calls microtin_mesh_triangle_count.
  uint32_t triangles() const { return microtin_mesh_triangle_count(mesh_); }
  // Calls microtin_mesh_digest.
  uint64_t digest() const { return microtin_mesh_digest(mesh_); }

  // Calls microtin_mesh_margins.
  void margins(uint32_t* below, uint32_t* above) const {
    microtin_mesh_margins(mesh_, below, above);
  }
  // Calls microtin_mesh_safe_heights_at.
  microtin_query_result safe_heights_at(int32_t x, int32_t y, uint32_t* hint,
                                        microtin_safe_heights* heights, uint32_t flags = 0,
                                        uint32_t step_limit = 0) const {
    return microtin_mesh_safe_heights_at(mesh_, x, y, hint, heights, flags, step_limit);
  }
  // Calls microtin_mesh_height_at.
  microtin_query_result height_at(int32_t x, int32_t y, uint32_t* hint, int32_t* height,
                                  uint32_t flags = 0, uint32_t step_limit = 0) const {
    return microtin_mesh_height_at(mesh_, x, y, hint, height, flags, step_limit);
  }
  // Calls microtin_mesh_segment_extremes.
  microtin_query_result segment_extremes(const microtin_segment& segment,
                                         microtin_segment_extremes* extremes) const {
    return microtin_mesh_segment_extremes(mesh_, &segment, nullptr, extremes, 0);
  }
  // Calls microtin_mesh_segment_extremes.
  microtin_query_result segment_extremes(const microtin_segment& segment,
                                         microtin_segment_state* state,
                                         microtin_segment_extremes* extremes,
                                         uint32_t step_limit) const {
    return microtin_mesh_segment_extremes(mesh_, &segment, state, extremes, step_limit);
  }
  // Calls microtin_mesh_path_clearance.
  microtin_query_result path_clearance(const microtin_path& path,
                                       microtin_path_clearance* clearance,
                                       uint32_t flags = 0) const {
    return microtin_mesh_path_clearance(mesh_, &path, nullptr, clearance, flags, 0);
  }
  // Calls microtin_mesh_path_clearance.
  microtin_query_result path_clearance(const microtin_path& path, microtin_segment_state* state,
                                       microtin_path_clearance* clearance, uint32_t flags,
                                       uint32_t step_limit) const {
    return microtin_mesh_path_clearance(mesh_, &path, state, clearance, flags, step_limit);
  }
  // Calls microtin_mesh_profile_next.
  microtin_query_result profile_next(const microtin_segment& segment, microtin_segment_state* state,
                                     microtin_crossing* crossing, uint32_t step_limit = 0) const {
    return microtin_mesh_profile_next(mesh_, &segment, state, crossing, step_limit);
  }
  // Calls microtin_mesh_gradient_at.
  microtin_query_result gradient_at(int32_t x, int32_t y, uint32_t* hint,
                                    microtin_gradient* gradient, uint32_t flags = 0,
                                    uint32_t step_limit = 0) const {
    return microtin_mesh_gradient_at(mesh_, x, y, hint, gradient, flags, step_limit);
  }
  // Calls microtin_mesh_heights_at.
  microtin_query_result heights_at(const microtin_position* positions, uint32_t count,
                                   uint32_t* hint, int32_t* heights) const {
    return microtin_mesh_heights_at(mesh_, positions, count, hint, heights);
  }
  // Calls microtin_mesh_grid_extremes.
  microtin_query_result grid_extremes(const microtin_grid_spec& grid,
                                      microtin_grid_extremes* extremes) const {
    return microtin_mesh_grid_extremes(mesh_, &grid, extremes);
  }
  // Calls microtin_mesh_sample_grid.
  microtin_query_result sample_grid(const microtin_grid_spec& grid, int16_t* heights) const {
    return microtin_mesh_sample_grid(mesh_, &grid, heights);
  }

 private:
  alignas(MICROTIN_ALIGNMENT) unsigned char storage_[MICROTIN_MESH_BYTES(Capacity)];
  microtin_mesh* mesh_ = nullptr;
  microtin_status status_ = MICROTIN_STATUS_OK;  // of the initialisation
};

// The state needed while decoding a terrain of up to Capacity vertices. Should its initialisation,
// or the terrain's, fail, status, feed and finish tell why, and nothing else may be called.
template <uint32_t Capacity>
class Decoder {
  static_assert(Capacity >= 3, "a terrain has at least three vertices");
  static_assert(Capacity <= MICROTIN_MAX_VERTICES, "more vertices than the index width reaches");

 public:
  // Decodes into a mesh, which must outlive the decoder.
  explicit Decoder(microtin_mesh* mesh) { begin(mesh); }
  // Decodes into a terrain, which must outlive the decoder.
  template <uint32_t MeshCapacity>
  explicit Decoder(Terrain<MeshCapacity>& target) {
    begin(target);
  }
  // Leaves the object to `begin`; see DeferInit.
  constexpr explicit Decoder(DeferInit) : storage_{} {}
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  // May be called again, for another terrain.
  microtin_status begin(microtin_mesh* mesh) {
    status_ = microtin_decoder_init(storage_, sizeof storage_, mesh, &decoder_);
    return status_;
  }
  // Initialises the object and returns the status.
  template <uint32_t MeshCapacity>
  microtin_status begin(Terrain<MeshCapacity>& target) {
    begin(target.mesh());
    if (target.status() != MICROTIN_STATUS_OK) status_ = target.status();
    return status_;
  }
  // The status of the initialisation.
  microtin_status status() const { return status_; }
  // Calls microtin_decoder_stop_after_phase.
  void stop_after_phase(uint32_t phase) { microtin_decoder_stop_after_phase(decoder_, phase); }
  // Calls microtin_decoder_feed.
  microtin_status feed(const uint8_t* bytes, size_t size, size_t* used, uint32_t step_limit = 0) {
    if (status_ == MICROTIN_STATUS_OK)
      return microtin_decoder_feed(decoder_, bytes, size, used, step_limit);
    *used = 0;
    return status_;
  }
  // Calls microtin_decoder_finish.
  microtin_status finish() {
    return status_ == MICROTIN_STATUS_OK ? microtin_decoder_finish(decoder_) : status_;
  }
  // Calls microtin_decoder_phase.
  uint32_t phase() const { return microtin_decoder_phase(decoder_); }
  // Calls microtin_decoder_bytes_used.
  uint64_t bytes_used() const { return microtin_decoder_bytes_used(decoder_); }

 private:
  alignas(MICROTIN_ALIGNMENT) unsigned char storage_[MICROTIN_DECODER_BYTES(Capacity)];
  microtin_decoder* decoder_ = nullptr;
  microtin_status status_ = MICROTIN_STATUS_OK;  // of the initialisation
};

// Hints for places anywhere in a terrain, from Side x Side buckets.
template <uint32_t Side>
class Buckets {
  static_assert(Side >= 1 && Side <= 1024, "1 to 1,024 buckets a side");

 public:
  constexpr Buckets() : storage_{}, buckets_(nullptr) {}
  Buckets(const Buckets&) = delete;
  Buckets& operator=(const Buckets&) = delete;

  // Call it when the terrain is decoded. Before that every hint is 0.
  microtin_status build(const microtin_mesh* mesh) {
    return microtin_buckets_init(storage_, sizeof storage_, mesh, &buckets_);
  }
  // Calls microtin_buckets_hint.
  uint32_t hint(int32_t x, int32_t y) const {
    return buckets_ == nullptr ? 0 : microtin_buckets_hint(buckets_, x, y);
  }

 private:
  alignas(MICROTIN_ALIGNMENT) unsigned char storage_[MICROTIN_BUCKETS_BYTES(Side)];
  microtin_buckets* buckets_;
};

// The compact form of a terrain of up to Capacity vertices; see compact.h. Narrow: its places lie
// in a box less than 256 steps wide and high.
template <uint32_t Capacity, bool Narrow = false>
class CompactTerrain {
 public:
  static constexpr unsigned long kBytes =
      Narrow ? MICROTIN_COMPACT_NARROW_BYTES(Capacity) : MICROTIN_COMPACT_BYTES(Capacity);

  constexpr CompactTerrain() : storage_{}, compact_(nullptr) {}
  CompactTerrain(const CompactTerrain&) = delete;
  CompactTerrain& operator=(const CompactTerrain&) = delete;

  // Makes the compact form of a decoded terrain, which is lost by that. The decoder serves as
  // scratch; call its begin before you feed it again. ARGUMENT: this object holds a terrain
  // already, which stays as it is; call clear first.
  template <class TerrainType, class DecoderType>
  microtin_status make(TerrainType& terrain, DecoderType& decoder) {
    if (compact_ != nullptr) return MICROTIN_STATUS_ARGUMENT;
    microtin_compactor* compactor = nullptr;
    const microtin_status status = microtin_compactor_init(
        storage_, sizeof storage_, terrain.mesh(), &decoder, sizeof decoder, &compactor);
    return status == MICROTIN_STATUS_OK ? microtin_compactor_run(compactor, &compact_, 0) : status;
  }

  // Null before make succeeds, and after clear.
  const microtin_compact* compact() const { return compact_; }
  // Makes the object empty.
  void clear() { compact_ = nullptr; }

  // Calls microtin_compact_vertex_count.
  uint32_t vertices() const { return microtin_compact_vertex_count(compact_); }
  // Calls microtin_compact_digest.
  uint64_t digest() const { return microtin_compact_digest(compact_); }
  // Calls microtin_compact_hint.
  uint32_t hint(int32_t x, int32_t y) const { return microtin_compact_hint(compact_, x, y); }
  // Calls microtin_compact_margins.
  void margins(uint32_t* below, uint32_t* above) const {
    microtin_compact_margins(compact_, below, above);
  }
  // Calls microtin_compact_safe_heights_at.
  microtin_query_result safe_heights_at(int32_t x, int32_t y, uint32_t* hint,
                                        microtin_safe_heights* heights,
                                        uint32_t step_limit = 0) const {
    return microtin_compact_safe_heights_at(compact_, x, y, hint, heights, step_limit);
  }
  // Calls microtin_compact_height_at.
  microtin_query_result height_at(int32_t x, int32_t y, uint32_t* hint, int32_t* height,
                                  uint32_t step_limit = 0) const {
    return microtin_compact_height_at(compact_, x, y, hint, height, step_limit);
  }
  // Calls microtin_compact_segment_extremes.
  microtin_query_result segment_extremes(const microtin_segment& segment,
                                         microtin_segment_extremes* extremes) const {
    return microtin_compact_segment_extremes(compact_, &segment, nullptr, extremes, 0);
  }
  // Calls microtin_compact_segment_extremes.
  microtin_query_result segment_extremes(const microtin_segment& segment,
                                         microtin_segment_state* state,
                                         microtin_segment_extremes* extremes,
                                         uint32_t step_limit) const {
    return microtin_compact_segment_extremes(compact_, &segment, state, extremes, step_limit);
  }
  // Calls microtin_compact_path_clearance.
  microtin_query_result path_clearance(const microtin_path& path,
                                       microtin_path_clearance* clearance,
                                       uint32_t flags = 0) const {
    return microtin_compact_path_clearance(compact_, &path, nullptr, clearance, flags, 0);
  }
  // Calls microtin_compact_path_clearance.
  microtin_query_result path_clearance(const microtin_path& path, microtin_segment_state* state,
                                       microtin_path_clearance* clearance, uint32_t flags,
                                       uint32_t step_limit) const {
    return microtin_compact_path_clearance(compact_, &path, state, clearance, flags, step_limit);
  }
  // Calls microtin_compact_profile_next.
  microtin_query_result profile_next(const microtin_segment& segment, microtin_segment_state* state,
                                     microtin_crossing* crossing, uint32_t step_limit = 0) const {
    return microtin_compact_profile_next(compact_, &segment, state, crossing, step_limit);
  }
  // Calls microtin_compact_gradient_at.
  microtin_query_result gradient_at(int32_t x, int32_t y, uint32_t* hint,
                                    microtin_gradient* gradient, uint32_t step_limit = 0) const {
    return microtin_compact_gradient_at(compact_, x, y, hint, gradient, step_limit);
  }
  // Calls microtin_compact_heights_at.
  microtin_query_result heights_at(const microtin_position* positions, uint32_t count,
                                   uint32_t* hint, int32_t* heights) const {
    return microtin_compact_heights_at(compact_, positions, count, hint, heights);
  }
  // Calls microtin_compact_grid_extremes.
  microtin_query_result grid_extremes(const microtin_grid_spec& grid,
                                      microtin_grid_extremes* extremes) const {
    return microtin_compact_grid_extremes(compact_, &grid, extremes);
  }
  // Calls microtin_compact_sample_grid.
  microtin_query_result sample_grid(const microtin_grid_spec& grid, int16_t* heights) const {
    return microtin_compact_sample_grid(compact_, &grid, heights);
  }

 private:
  alignas(MICROTIN_ALIGNMENT) unsigned char storage_[kBytes];
  microtin_compact* compact_;
};

}  // namespace microtin

#endif
