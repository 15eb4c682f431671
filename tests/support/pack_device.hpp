// SPDX-License-Identifier: MIT
// A device that reads a pack from a card, and what it should answer.
#ifndef MICROTIN_TESTS_SUPPORT_PACK_DEVICE_HPP
#define MICROTIN_TESTS_SUPPORT_PACK_DEVICE_HPP

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "encoder/pack/surface.hpp"
#include "microtin/compact_pack.h"
#include "tests/support/device.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/reference_segment.hpp"

namespace microtin::tests {

constexpr uint32_t kCapacity = 100;

// A card that counts its reads, fails at will and gives few bytes at a time.
struct Card {
  Bytes bytes;
  size_t most = 1000;      // bytes given at a time
  uint32_t failing = ~0u;  // number of the read that fails
  uint32_t reads = 0;
  bool is_pulled = false;  // every read fails

  static int32_t read(void* context, uint64_t offset, uint8_t* buffer, size_t size) {
    Card& card = *static_cast<Card*>(context);
    if (size < 1 || size > 128 || card.reads > 200000) FAIL("a read too large, or one too many");
    if (card.reads++ == card.failing || card.is_pulled) return -1;
    if (offset >= card.bytes.size()) return 0;
    const size_t left = card.bytes.size() - static_cast<size_t>(offset);
    const size_t taken = std::min({size, left, card.most});
    std::memcpy(buffer, card.bytes.data() + offset, taken);
    return static_cast<int32_t>(taken);
  }
};

// A device whose slots hold meshes, or compact terrains, which answer the same.
class PackDevice {
 public:
  PackDevice(const PackDevice&) = delete;
  PackDevice& operator=(const PackDevice&) = delete;

  microtin_status load(Card& card, const microtin_segment& segment, uint32_t steps = 0) const {
    return load_with(segment, Card::read, &card, steps);
  }
  microtin_status load_with(const microtin_segment& segment, microtin_read read, void* context,
                            uint32_t steps) const {
    return is_compact_ ? microtin_compact_pack_load_with(pack, &segment, read, context, steps)
                       : microtin_pack_load_with(pack, &segment, read, context, steps);
  }
  microtin_status load_without_reading(const microtin_segment& segment, uint32_t steps) const {
    return is_compact_ ? microtin_compact_pack_load(pack, &segment, steps)
                       : microtin_pack_load(pack, &segment, steps);
  }
  microtin_query_result height_at(int64_t x, int64_t y, int32_t& height) const {
    uint32_t hint = 0;
    return is_compact_ ? microtin_compact_pack_height_at(pack, x, y, &hint, &height)
                       : microtin_pack_height_at(pack, x, y, &hint, &height);
  }
  microtin_query_result segment_extremes(const microtin_segment& segment,
                                         microtin_segment_extremes* extremes) const {
    return is_compact_ ? microtin_compact_pack_segment_extremes(pack, &segment, extremes)
                       : microtin_pack_segment_extremes(pack, &segment, extremes);
  }
  microtin_query_result path_clearance(const microtin_path& path,
                                       microtin_path_clearance* clearance, uint32_t flags) const {
    return is_compact_ ? microtin_compact_pack_path_clearance(pack, &path, clearance, flags)
                       : microtin_pack_path_clearance(pack, &path, clearance, flags);
  }
  microtin_status search_path(const microtin_path& path, uint32_t flags,
                              microtin_path_search* search, uint32_t steps) const {
    return is_compact_ ? microtin_compact_pack_search_path(pack, &path, flags, search, steps)
                       : microtin_pack_search_path(pack, &path, flags, search, steps);
  }
  microtin_status search_path_with(const microtin_path& path, uint32_t flags,
                                   microtin_path_search* search, Card& card) const {
    return is_compact_
               ? microtin_compact_pack_search_path_with(pack, &path, flags, search, Card::read,
                                                        &card)
               : microtin_pack_search_path_with(pack, &path, flags, search, Card::read, &card);
  }
  microtin_query_result profile_next(const microtin_segment& segment, microtin_segment_state* state,
                                     microtin_crossing* crossing) const {
    return is_compact_ ? microtin_compact_pack_profile_next(pack, &segment, state, crossing)
                       : microtin_pack_profile_next(pack, &segment, state, crossing);
  }
  microtin_query_result highest_on(const microtin_segment& segment, int32_t* height) const {
    microtin_segment_extremes extremes;
    const microtin_query_result answer = segment_extremes(segment, &extremes);
    *height = extremes.highest;
    return answer;
  }
  microtin_query_result gradient_at(int64_t x, int64_t y, microtin_gradient* gradient) const {
    uint32_t hint = 0;
    return is_compact_ ? microtin_compact_pack_gradient_at(pack, x, y, &hint, gradient)
                       : microtin_pack_gradient_at(pack, x, y, &hint, gradient);
  }
  microtin_query_result heights_at(const std::vector<microtin_position>& positions,
                                   std::vector<int32_t>& heights) const {
    uint32_t hint = 0;
    const uint32_t count = static_cast<uint32_t>(positions.size());
    return is_compact_
               ? microtin_compact_pack_heights_at(pack, positions.data(), count, &hint,
                                                  heights.data())
               : microtin_pack_heights_at(pack, positions.data(), count, &hint, heights.data());
  }
  microtin_query_result grid_extremes(const microtin_grid_spec& grid,
                                      microtin_grid_extremes* extremes) const {
    return is_compact_ ? microtin_compact_pack_grid_extremes(pack, &grid, extremes)
                       : microtin_pack_grid_extremes(pack, &grid, extremes);
  }
  microtin_query_result sample_grid(const microtin_grid_spec& block, int16_t* heights) const {
    return is_compact_ ? microtin_compact_pack_sample_grid(pack, &block, heights)
                       : microtin_pack_sample_grid(pack, &block, heights);
  }

 private:
  bool is_compact_;
  Workspace space_;

 public:
  microtin_pack* pack = nullptr;

 protected:
  PackDevice(bool is_compact, size_t bytes) : is_compact_(is_compact), space_(bytes) {}
  ~PackDevice() { CHECK(space_.guards_are_whole()); }

  Workspace& space() { return space_; }
};

struct MeshSlots : PackDevice {
  explicit MeshSlots(uint32_t slots, uint32_t capacity = kCapacity)
      : PackDevice(false, MICROTIN_PACK_BYTES(slots, capacity)) {
    REQUIRE(microtin_pack_init(space().begin(), space().size(), slots, capacity, &pack) ==
            MICROTIN_STATUS_OK);
  }
};

struct CompactSlots : PackDevice {
  explicit CompactSlots(uint32_t slots, uint32_t capacity = kCapacity)
      : CompactSlots(slots, capacity, static_cast<uint32_t>(MICROTIN_COMPACT_BYTES(capacity))) {}
  CompactSlots(uint32_t slots, uint32_t capacity, uint32_t tile_bytes)
      : PackDevice(true, MICROTIN_COMPACT_PACK_BYTES(slots, capacity, tile_bytes)) {
    REQUIRE(microtin_compact_pack_init(space().begin(), space().size(), slots, capacity, tile_bytes,
                                       &pack) == MICROTIN_STATUS_OK);
  }
};

// The slots that the adapters are compiled for.
#ifdef MICROTIN_ADAPTERS_COMPACT
using AdapterSlots = CompactSlots;
#else
using AdapterSlots = MeshSlots;
#endif

inline microtin_segment at(int64_t x, int64_t y) {
  return {x * 256, y * 256, x * 256, y * 256};
}

// What the tiles answer on a host.
inline std::optional<int32_t> expected_height(const PackFile& pack, int64_t x, int64_t y) {
  for (uint32_t number = 0; number < pack.entries().size(); ++number) {
    const TileBox box = tile_box(pack.grid(), number);
    const std::optional<DecodedTerrain> tile = pack.tile(number);
    const int64_t lx = x - int64_t{box.x} * 256, ly = y - int64_t{box.y} * 256;
    if (!tile || lx < 0 || ly < 0 || x > int64_t{box.x_end} * 256 || y > int64_t{box.y_end} * 256) {
      continue;
    }
    uint32_t hint = 0;
    int32_t height = 0;
    if (microtin_mesh_height_at(tile->mesh(), static_cast<int32_t>(lx), static_cast<int32_t>(ly),
                                &hint, &height, 0, 0) == MICROTIN_QUERY_OK) {
      return height;
    }
  }
  return std::nullopt;
}

// The greatest height on a segment where it meets edges of a surface, in floating point; steps.
inline double highest_on_edges(const SurfaceModel& model, const microtin_segment& c) {
  const double x = static_cast<double>(c.x) / 256, y = static_cast<double>(c.y) / 256,
               dx = static_cast<double>(c.x_end) / 256 - x,
               dy = static_cast<double>(c.y_end) / 256 - y;
  double highest = -1e9;
  for (const auto& corners : model.triangles) {
    for (size_t i = 0; i < 3; ++i) {
      const auto &a = model.vertices[corners[i]], &b = model.vertices[corners[(i + 1) % 3]];
      const double ax = static_cast<double>(a[0]) - x, ay = static_cast<double>(a[1]) - y,
                   ex = static_cast<double>(b[0] - a[0]), ey = static_cast<double>(b[1] - a[1]);
      const double across = dx * ey - dy * ex;
      if (across == 0) continue;
      const double along = (ax * ey - ay * ex) / across, on_edge = (ax * dy - ay * dx) / across;
      if (along < 0 || along > 1 || on_edge < 0 || on_edge > 1) continue;
      const double z = static_cast<double>(a[2]) + on_edge * static_cast<double>(b[2] - a[2]);
      highest = std::max(highest, z);
    }
  }
  return highest;
}

// The triangles of all tiles.
inline reference::Surface surface_of(const PackFile& pack) {
  reference::Surface surface;
  for (uint32_t number = 0; number < pack.entries().size(); ++number) {
    const std::optional<DecodedTerrain> tile = pack.tile(number);
    if (!tile) continue;
    const TileBox box = tile_box(pack.grid(), number);
    surface.add(tile->mesh(), box.x, box.y);
  }
  return surface;
}

// Why a tile is bad; OK if it is not known to be.
inline microtin_status why_bad(const PackDevice& device, uint32_t tile) {
  for (uint32_t i = 0; i < MICROTIN_PACK_MAX_BAD_TILES; ++i) {
    uint32_t number = 0, why = MICROTIN_STATUS_OK;
    if (microtin_pack_bad_tile(device.pack, i, &number, &why) == MICROTIN_STATUS_OK &&
        number == tile) {
      return static_cast<microtin_status>(why);
    }
  }
  return MICROTIN_STATUS_OK;
}

}  // namespace microtin::tests

#endif
