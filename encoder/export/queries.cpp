// SPDX-License-Identifier: MIT
// Queries streams and packs for heights; keeps some of a pack's tiles decoded.
#include "encoder/export/queries.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/terrain/exact_query.hpp"

namespace microtin::exporting {
namespace {

constexpr ExactAnswer kNothing{MICROTIN_QUERY_OUTSIDE, {0, 0, 1}};

bool holds(int64_t low, int64_t high, int64_t whole, Wide part) {
  return low <= whole && (whole < high || (whole == high && part == 0));
}

bool holds(const SampledSurface& surface, const RealPlace& p) {
  return holds(surface.x_min, surface.x_max, p.x, p.x_part) &&
         holds(surface.y_min, surface.y_max, p.y, p.y_part);
}

// A sampler answers in the surface's box alone.
template <class Sampler>
void sample_with(SampledSurface& surface, std::shared_ptr<Sampler> sampler) {
  surface.height_at = [box = surface, sampler](const RealPlace& place) {
    return holds(box, place) ? sampler->height_at(place) : kNothing;
  };
}

// Walks from where the last question ended or, if that is far, from a bucket.
class MeshSampler {
 public:
  explicit MeshSampler(const microtin_mesh* mesh) : mesh_(mesh) {}
  MeshSampler(const MeshSampler&) = delete;
  MeshSampler& operator=(const MeshSampler&) = delete;

  ExactAnswer height_at(const RealPlace& place) {
    constexpr uint32_t kNearby = 16;  // steps
    const ExactAnswer answer = exact_answer(mesh_, place, kNearby, &hint_);
    if (answer.kind != MICROTIN_QUERY_STEP_LIMIT) return answer;
    hint_ = microtin_buckets_hint(buckets(), static_cast<int32_t>(place.x * 256),
                                  static_cast<int32_t>(place.y * 256));
    return exact_answer(mesh_, place, 0, &hint_);
  }

 private:
  const microtin_buckets* buckets() {
    if (buckets_ != nullptr) return buckets_;
    constexpr double kMostBuckets = 1023;  // a side
    const double side_wanted = std::sqrt(microtin_mesh_vertex_count(mesh_));
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
  PackSampler(const PackFile& pack, BadTiles bad_tiles, uint64_t most_vertices)
      : pack_(pack), grid_(pack.grid()), bad_tiles_(bad_tiles), most_vertices_(most_vertices) {}

  // A height that any tile has counts, then that one is bad, then that none has terrain there.
  ExactAnswer height_at(const RealPlace& place) {
    const TileSpan columns = tiles_with(place.x, place.x_part, grid_.width, tile_columns(grid_));
    const TileSpan rows = tiles_with(place.y, place.y_part, grid_.height, tile_rows(grid_));
    ExactAnswer worst{MICROTIN_QUERY_VOID, {0, 0, 1}};
    for (uint32_t row = rows.first; row <= rows.last; ++row) {
      for (uint32_t column = columns.first; column <= columns.last; ++column) {
        const ExactAnswer answer = ask_tile(row * tile_columns(grid_) + column, place);
        if (answer.kind == MICROTIN_QUERY_OK) return answer;
        if (answer.kind == MICROTIN_QUERY_BAD_TILE) worst = answer;
      }
    }
    return worst;
  }

  TileMesh mesh_of(uint32_t number) {
    const Tile& tile = tile_of(number);
    return {tile.terrain ? tile.terrain->mesh() : nullptr,
            tile.is_bad ? MICROTIN_QUERY_BAD_TILE : MICROTIN_QUERY_VOID};
  }

 private:
  struct Tile {
    explicit Tile(std::optional<DecodedTerrain> decoded)
        : terrain(std::move(decoded)), sampler(terrain ? terrain->mesh() : nullptr) {}

    std::optional<DecodedTerrain> terrain;  // nothing if there is none
    MeshSampler sampler;
    bool is_bad = false;
    std::string fault;  // of a bad one
    uint64_t used = 0;  // when it was needed last

    uint32_t vertices() const { return terrain ? microtin_mesh_vertex_count(terrain->mesh()) : 0; }
  };

  Tile& tile_of(uint32_t number) {
    Tile& tile = known_tile(number);
    tile.used = ++clock_;
    return tile;
  }

  Tile& known_tile(uint32_t number) {
    const auto found = tiles_.find(number);
    if (found != tiles_.end()) return found->second;
    make_room();
    try {
      Tile& tile = tiles_.try_emplace(number, pack_.tile(number)).first->second;
      vertices_ += tile.vertices();
      return tile;
    } catch (const Error& error) {
      Tile& bad = tiles_.try_emplace(number, std::nullopt).first->second;
      bad.is_bad = true;
      bad.fault = error.text();
      return bad;
    }
  }

  ExactAnswer ask_tile(uint32_t number, const RealPlace& place) {
    Tile& tile = tile_of(number);
    if (tile.is_bad && bad_tiles_ == BadTiles::kThrow) throw Error(tile.fault);
    if (tile.is_bad) return {MICROTIN_QUERY_BAD_TILE, {0, 0, 1}};
    if (!tile.terrain) return {MICROTIN_QUERY_VOID, {0, 0, 1}};
    const TileBox box = tile_box(grid_, number);
    RealPlace local = place;
    local.x -= box.x;
    local.y -= box.y;
    return tile.sampler.height_at(local);
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
        [](const auto& a, const auto& b) { return a.second.used < b.second.used; });
    vertices_ -= first->second.vertices();
    tiles_.erase(first);
  }

  const PackFile& pack_;
  TileGrid grid_;
  BadTiles bad_tiles_;
  std::map<uint32_t, Tile> tiles_;
  uint64_t most_vertices_, vertices_ = 0;  // of the tiles that are kept
  uint64_t clock_ = 0;
};

}  // namespace

TileSpan tiles_with(int64_t whole, Wide part, uint32_t side, uint32_t count) {
  const auto last = static_cast<uint32_t>(std::min<int64_t>(whole / side, count - 1));
  const bool is_border = part == 0 && last != 0 && whole == int64_t{last} * side;
  return {is_border ? last - 1 : last, last};
}

SampledSurface sampled(const microtin_mesh* mesh) {
  SampledSurface surface;
  microtin_mesh_axes(mesh, &surface.placement.x, &surface.placement.y, &surface.placement.z);
  for (uint32_t v = 0; v < microtin_mesh_vertex_count(mesh); ++v) {
    const auto [x, y, z] = vertex_of(mesh, v);
    surface.x_min = v == 0 ? x : std::min<int64_t>(surface.x_min, x);
    surface.y_min = v == 0 ? y : std::min<int64_t>(surface.y_min, y);
    surface.x_max = std::max<int64_t>(surface.x_max, x);
    surface.y_max = std::max<int64_t>(surface.y_max, y);
    surface.lowest = v == 0 ? z : std::min<int32_t>(surface.lowest, z);
    surface.highest = v == 0 ? z : std::max<int32_t>(surface.highest, z);
  }
  surface.mesh_of = [mesh](uint32_t) { return TileMesh{mesh, MICROTIN_QUERY_OUTSIDE}; };
  sample_with(surface, std::make_shared<MeshSampler>(mesh));
  return surface;
}

SampledSurface sampled(const PackFile& pack, BadTiles bad_tiles, uint64_t kept_vertices) {
  SampledSurface surface;
  surface.placement = pack.metadata().placement;
  surface.x_max = pack.grid().x_max;
  surface.y_max = pack.grid().y_max;
  surface.lowest = pack.header().lowest;
  surface.highest = pack.header().highest;
  surface.tiles = pack.grid();
  const auto sampler = std::make_shared<PackSampler>(pack, bad_tiles, kept_vertices);
  surface.mesh_of = [sampler](uint32_t tile) { return sampler->mesh_of(tile); };
  sample_with(surface, sampler);
  return surface;
}

namespace {

// The triangle whose centre lies farthest east, and of those with the same x farthest north.
class BestTriangle {
 public:
  // The corners are those of a tile that begins at (x, y).
  void look_at(const std::array<Vertex, 3>& v, int64_t x, int64_t y) {
    const Centre centre = {3 * x + v[0].x + v[1].x + v[2].x, 3 * y + v[0].y + v[1].y + v[2].y};
    if (best_ && centre <= centre_) return;
    centre_ = centre;
    const int64_t bx = v[1].x - v[0].x, by = v[1].y - v[0].y, bz = v[1].z - v[0].z,
                  cx = v[2].x - v[0].x, cy = v[2].y - v[0].y, cz = v[2].z - v[0].z;
    const auto whole = static_cast<double>(bx * cy - cx * by);
    best_ = LatticeGradient{static_cast<double>(bz * cy - cz * by) / whole,
                            static_cast<double>(bx * cz - cx * bz) / whole};
  }

  const std::optional<LatticeGradient>& gradient() const { return best_; }

 private:
  using Centre = std::array<int64_t, 2>;  // three times

  Centre centre_{};
  std::optional<LatticeGradient> best_;
};

}  // namespace

std::optional<LatticeGradient> gradient_at(const SampledSurface& surface, const RealPlace& place,
                                           GradientSearch& search) {
  if (surface.height_at(place).kind != MICROTIN_QUERY_OK) return std::nullopt;
  const TileGrid& grid = surface.tiles;
  const TileSpan columns = tiles_with(place.x, place.x_part, grid.width, tile_columns(grid));
  const TileSpan rows = tiles_with(place.y, place.y_part, grid.height, tile_rows(grid));
  BestTriangle best;
  for (uint32_t row = rows.first; row <= rows.last; ++row) {
    for (uint32_t column = columns.first; column <= columns.last; ++column) {
      const uint32_t tile = row * tile_columns(grid) + column;
      const microtin_mesh* const mesh = surface.mesh_of(tile).mesh;
      if (mesh == nullptr) continue;
      if (mesh != search.mesh) search = {mesh, 0};
      const TileBox box = tile_box(grid, tile);
      RealPlace local = place;
      local.x -= box.x;
      local.y -= box.y;
      if (exact_answer(mesh, local, 0, &search.hint).kind != MICROTIN_QUERY_OK) continue;
      for (const std::array<Vertex, 3>& corners : triangles_at(mesh, local, search.hint)) {
        best.look_at(corners, box.x, box.y);
      }
    }
  }
  return best.gradient();
}

}  // namespace microtin::exporting
