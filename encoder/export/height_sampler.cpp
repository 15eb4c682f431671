// SPDX-License-Identifier: MIT
// Asks streams and packs for heights; keeps some of a pack's tiles decoded.
#include "encoder/export/height_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/exact/mesh_vertex.hpp"

namespace microtin::exporting {
namespace {

constexpr int64_t kFraction = 256;  // places have 8 fractional bits

bool holds(const SampledSurface& surface, int64_t x, int64_t y) {
  return surface.x_min * kFraction <= x && x <= surface.x_max * kFraction &&
         surface.y_min * kFraction <= y && y <= surface.y_max * kFraction;
}

// A sampler answers in the surface's box alone.
template <class Sampler>
void ask(SampledSurface& surface, std::shared_ptr<Sampler> sampler) {
  surface.height_at = [box = surface, sampler](int64_t x, int64_t y) {
    return holds(box, x, y) ? sampler->height_at(x, y) : std::nullopt;
  };
}

// Walks from where the last question ended or, if that is far, from a bucket.
class MeshSampler {
 public:
  explicit MeshSampler(const microtin_mesh* mesh) : mesh_(mesh) {}
  MeshSampler(const MeshSampler&) = delete;
  MeshSampler& operator=(const MeshSampler&) = delete;

  std::optional<int32_t> height_at(int64_t x, int64_t y) {
    constexpr uint32_t kNearby = 16;  // steps
    const auto px = static_cast<int32_t>(x), py = static_cast<int32_t>(y);
    int32_t height = 0;
    microtin_answer answer = microtin_height_at_limited(mesh_, px, py, 0, kNearby, &hint_, &height);
    if (answer == MICROTIN_NOT_YET) {
      hint_ = microtin_buckets_hint(buckets(), px, py);
      answer = microtin_height_at(mesh_, px, py, 0, &hint_, &height);
    }
    if (answer != MICROTIN_HEIGHT) return std::nullopt;
    return height;
  }

 private:
  const microtin_buckets* buckets() {
    if (buckets_ != nullptr) return buckets_;
    constexpr double kMostBuckets = 1023;  // a side
    const double side_wanted = std::sqrt(microtin_vertex_count(mesh_));
    const size_t side = static_cast<size_t>(std::min(side_wanted, kMostBuckets)) + 1;
    storage_.resize((MICROTIN_BUCKETS_BYTES(side) + 7) / 8);
    microtin_buckets_init(storage_.data(), storage_.size() * 8, mesh_, &buckets_);
    return buckets_;
  }

  const microtin_mesh* mesh_;
  uint32_t hint_ = 0;
  std::vector<uint64_t> storage_;  // aligned to MICROTIN_ALIGNMENT; buckets_ points into it
  microtin_buckets* buckets_ = nullptr;
};

class PackSampler {
 public:
  PackSampler(const PackFile& pack, uint64_t most_vertices)
      : pack_(pack), grid_(pack.grid()), most_vertices_(most_vertices) {}

  std::optional<int32_t> height_at(int64_t x, int64_t y) {
    const Range columns = tiles(x, grid_.width, tile_columns(grid_));
    const Range rows = tiles(y, grid_.height, tile_rows(grid_));
    for (uint32_t row = rows.first; row <= rows.last; ++row) {
      for (uint32_t column = columns.first; column <= columns.last; ++column) {
        const auto height = ask_tile(row * tile_columns(grid_) + column, x, y);
        if (height) return height;
      }
    }
    return std::nullopt;
  }

 private:
  struct Range {
    uint32_t first, last;
  };
  struct Tile {
    explicit Tile(std::optional<DecodedTerrain> decoded)
        : terrain(std::move(decoded)), sampler(terrain ? terrain->mesh() : nullptr) {}

    std::optional<DecodedTerrain> terrain;  // nothing if there is none
    MeshSampler sampler;
    uint64_t asked = 0;  // when it was asked last

    uint32_t vertices() const { return terrain ? microtin_vertex_count(terrain->mesh()) : 0; }
  };

  // On a border two tiles have a say.
  static Range tiles(int64_t place, uint32_t side, uint32_t count) {
    const int64_t width = side * kFraction;
    const auto last = static_cast<uint32_t>(std::min<int64_t>(place / width, count - 1));
    return {place % width == 0 && place == last * width && last != 0 ? last - 1 : last, last};
  }

  std::optional<int32_t> ask_tile(uint32_t number, int64_t x, int64_t y) {
    auto found = tiles_.find(number);
    if (found == tiles_.end()) {
      make_room();
      found = tiles_.try_emplace(number, pack_.tile(number)).first;
      vertices_ += found->second.vertices();
    }
    Tile& tile = found->second;
    tile.asked = ++clock_;
    if (!tile.terrain) return std::nullopt;
    const TileBox box = tile_box(grid_, number);
    return tile.sampler.height_at(x - box.x * kFraction, y - box.y * kFraction);
  }

  // For one tile more.
  void make_room() {
    constexpr size_t kFewest = 3;
    if (tiles_.size() >= 2 * size_t{tile_columns(grid_)}) forget_one();
    while (tiles_.size() > kFewest && vertices_ > most_vertices_) forget_one();
  }

  void forget_one() {
    const auto first = std::min_element(
        tiles_.begin(), tiles_.end(),
        [](const auto& a, const auto& b) { return a.second.asked < b.second.asked; });
    vertices_ -= first->second.vertices();
    tiles_.erase(first);
  }

  const PackFile& pack_;
  TileGrid grid_;
  std::map<uint32_t, Tile> tiles_;
  uint64_t most_vertices_, vertices_ = 0;  // of the tiles that are kept
  uint64_t clock_ = 0;
};

}  // namespace

SampledSurface sampled(const microtin_mesh* mesh) {
  SampledSurface surface;
  microtin_placement(mesh, &surface.placement.x, &surface.placement.y, &surface.placement.z);
  for (uint32_t v = 0; v < microtin_vertex_count(mesh); ++v) {
    const auto [x, y, z] = vertex_of(mesh, v);
    surface.x_min = v == 0 ? x : std::min<int64_t>(surface.x_min, x);
    surface.y_min = v == 0 ? y : std::min<int64_t>(surface.y_min, y);
    surface.x_max = std::max<int64_t>(surface.x_max, x);
    surface.y_max = std::max<int64_t>(surface.y_max, y);
    surface.lowest = v == 0 ? z : std::min<int32_t>(surface.lowest, z);
    surface.highest = v == 0 ? z : std::max<int32_t>(surface.highest, z);
  }
  ask(surface, std::make_shared<MeshSampler>(mesh));
  return surface;
}

SampledSurface sampled(const PackFile& pack, uint64_t kept_vertices) {
  SampledSurface surface;
  surface.placement = pack.metadata().placement;
  surface.x_max = pack.grid().x_max;
  surface.y_max = pack.grid().y_max;
  surface.lowest = pack.header().lowest;
  surface.highest = pack.header().highest;
  ask(surface, std::make_shared<PackSampler>(pack, kept_vertices));
  return surface;
}

}  // namespace microtin::exporting
