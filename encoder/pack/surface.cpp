// SPDX-License-Identifier: MIT
// Joins the tiles of a pack; compares them with a raster, a row of tiles at a time.
#include "encoder/pack/surface.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/work.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/pack/borders.hpp"
#include "encoder/pack/tiled_lines.hpp"
#include "encoder/verify/everywhere.hpp"
#include "encoder/verify/verify.hpp"

namespace microtin::pack {
namespace {

// Collects the tiles' vertices, those on borders once.
class Joining {
 public:
  explicit Joining(const TileGrid& grid) : grid_(grid) {}

  void add(const TileBox& box, const SurfaceModel& tile) {
    std::vector<uint32_t> number;
    for (const auto& [x, y, z] : tile.vertices) {
      number.push_back(
          number_of({box.x + static_cast<uint32_t>(x), box.y + static_cast<uint32_t>(y)}, z));
    }
    for (const auto& [a, b, c] : tile.triangles) {
      all_.triangles.push_back({number[a], number[b], number[c]});
    }
  }

  SurfaceModel take() { return std::move(all_); }

 private:
  uint32_t number_of(GlobalPost place, int64_t z) {
    const auto next = static_cast<uint32_t>(all_.vertices.size());
    if (place.x % grid_.width == 0 || place.y % grid_.height == 0) {
      const auto [found, is_new] = shared_.emplace(place, next);
      if (!is_new) {
        if (all_.vertices[found->second][2] != z) {
          throw Error("two tiles differ in the height at x " + std::to_string(place.x) + ", y " +
                      std::to_string(place.y));
        }
        return found->second;
      }
    }
    all_.vertices.push_back({place.x, place.y, z});
    return next;
  }

  TileGrid grid_;
  SurfaceModel all_;
  std::map<GlobalPost, uint32_t> shared_;
};

struct VerifiedTile {
  Verification all;
  uint64_t posts = 0, voids = 0;      // those of a tile south or west are not counted again
  std::vector<GlobalPost> uncovered;  // by this tile
  VisitLog visits;                    // if somebody wants to know
};

VerifiedTile verify_tile(const PackFile& pack, uint32_t number, const RasterReader& raster,
                         const std::optional<Decimal>& bound, bool keeps_visits) {
  const TileBox box = tile_box(pack.grid(), number);
  const Raster part = raster.read({box.x, box.y, box.x_end - box.x + 1, box.y_end - box.y + 1});
  const std::optional<DecodedTerrain> tile = pack.tile(number);
  const microtin_mesh* const mesh = tile ? tile->mesh() : nullptr;
  VerifiedTile verified;
  if (tile) {
    verified.all =
        verifying::verify(mesh, {part.x, part.y, pack.metadata().placement.z}, part, bound,
                          keeps_visits ? verified.visits.recorder(box.x, box.y) : PostVisitor());
    const Axis& z = pack.metadata().placement.z;
    verified.all.everywhere = measure_everywhere(mesh, {part.x, part.y, z}, part);
    if (verified.all.everywhere) {
      verified.all.broken =
          broken_promise(stated_everywhere(pack.margins(number), z), *verified.all.everywhere,
                         "tile " + std::to_string(number) + ": everywhere");
    }
  }
  if (!tile || verified.all.uncovered != 0) verified.uncovered = uncovered_posts(mesh, part, box);
  for_each_post(part, [&](int64_t x, int64_t y, int64_t z) {
    const bool is_first = (x != 0 || box.x == 0) && (y != 0 || box.y == 0);
    if (is_first) ++(z == kVoidHeight ? verified.voids : verified.posts);
  });
  return verified;
}

// Posts of borders that tiles do not cover, until all tiles that hold them have been seen.
class Uncovered {
 public:
  explicit Uncovered(const TileGrid& grid) : grid_(grid) {}

  void add(const std::vector<GlobalPost>& posts) {
    for (const GlobalPost post : posts) {
      const std::size_t holders = tiles_at(grid_, post).size();
      if (holders == 1 || ++by_[post] == holders) ++count_;
    }
  }

  // No tile that comes holds posts south of that row.
  void forget(uint32_t row) {
    for (auto at = by_.begin(); at != by_.end();) {
      at = at->first.y < row ? by_.erase(at) : std::next(at);
    }
  }

  uint64_t count() const { return count_; }

 private:
  TileGrid grid_;
  std::map<GlobalPost, std::size_t> by_;
  uint64_t count_ = 0;
};

}  // namespace

void expect_posts_of(const Raster& frame, const PackFile& pack) {
  const Placement& placement = pack.metadata().placement;
  if (frame.width != pack.grid().x_max + 1 || frame.height != pack.grid().y_max + 1 ||
      !is_same(frame.x, placement.x) || !is_same(frame.y, placement.y)) {
    throw Error(
        "the terrain is not a raster with the posts of the pack: name all files that it was made "
        "of");
  }
}

SurfaceModel model_of(const PackFile& pack) {
  Joining joining(pack.grid());
  for (uint32_t number = 0; number < pack.entries().size(); ++number) {
    const std::optional<DecodedTerrain> tile = pack.tile(number);
    if (tile) joining.add(tile_box(pack.grid(), number), stream::model_of(tile->mesh()));
  }
  SurfaceModel model = joining.take();
  model.placement = pack.metadata().placement;
  return model;
}

FoundBreaklines find_breaklines(const PackFile& pack, const RasterReader& raster,
                                const std::vector<RealLine>& lines,
                                const std::optional<LineRoom>& room) {
  expect_posts_of(raster.frame(), pack);
  const TileGrid& grid = pack.grid();
  const Placement lattice = pack.metadata().placement;
  const TiledLines tiled(lines, lattice, {0, 0, grid.x_max, grid.y_max});
  FoundBreaklines all;
  for (uint32_t number = 0; number < pack.entries().size(); ++number) {
    const TileBox box = tile_box(grid, number);
    const LinesInTile in_tile = tiled.in_tile(grid, box);
    if (in_tile.paths.empty()) continue;
    const Raster part = raster.read({box.x, box.y, box.x_end - box.x + 1, box.y_end - box.y + 1});
    const std::vector<LatticeLine> parts = parts_of(in_tile, part);
    const std::optional<DecodedTerrain> tile = pack.tile(number);
    if (parts.empty() || !tile) continue;
    add(verifying::find_breaklines(tile->mesh(), parts, room, {part.x, part.y, lattice.z}), all);
  }
  return all;
}

Verification verify(const PackFile& pack, const RasterReader& raster,
                    const std::optional<Decimal>& bound, const Progress& progress,
                    const PostVisitor& visit) {
  expect_posts_of(raster.frame(), pack);
  const TileGrid& grid = pack.grid();
  const uint32_t columns = tile_columns(grid);
  std::vector<Verification> parts;
  Uncovered uncovered(grid);
  uint64_t posts = 0, voids = 0;
  CountedProgress done(progress, pack.entries().size());
  for (uint32_t row = 0; row < tile_rows(grid); ++row) {
    std::vector<VerifiedTile> tiles(columns);
    for_each_parallel(columns, [&](std::size_t i) {
      tiles[i] = verify_tile(pack, row * columns + static_cast<uint32_t>(i), raster, bound,
                             static_cast<bool>(visit));
      done.add_one();
    });
    for (const VerifiedTile& tile : tiles) {
      parts.push_back(tile.all);
      uncovered.add(tile.uncovered);
      posts += tile.posts;
      voids += tile.voids;
      if (visit) tile.visits.replay(visit);
    }
    uncovered.forget((row + 1) * grid.height);
  }
  Verification all = combine(parts);
  const auto broken = std::find_if(parts.begin(), parts.end(),
                                   [](const Verification& part) { return !part.broken.empty(); });
  if (broken != parts.end()) all.broken = broken->broken;
  all.uncovered = uncovered.count();
  all.posts = posts;
  all.voids = voids;
  all.covered = posts - all.uncovered;
  return all;
}

}  // namespace microtin::pack
