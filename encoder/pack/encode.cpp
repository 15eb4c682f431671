// SPDX-License-Identifier: MIT
// Plans the tiles and encodes them in parallel; gives them away in order.
#include "encoder/pack/encode.hpp"

#include <cstddef>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/work.hpp"
#include "encoder/fit/simplify.hpp"
#include "encoder/pack/kept_tiles.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/verify/everywhere.hpp"

namespace microtin::pack {
namespace {

// Parts of the time, estimated: reading the raster first, and choosing the step of heights.
constexpr double kScanPart = 0.02, kStepPart = 0.05;

// Steps that suit borders, too, in hundredths of the bound, or of half of one that is one-sided: of
// coarser ones, which may suit a stream, their chains have too few heights to choose from.
constexpr int kStepsToTry[] = {50, 60};

// The z step that suits a part of the raster best: that of its stream, or one of ours. Tiles with
// posts of the least bound anywhere must be able to keep it.
Decimal choose_z_step(const Raster& part, Decimal least, bool has_lines,
                      const LatticeOptions& lattice, SimplifyOptions options) {
  if (options.search == Search::kNormal) options.search = Search::kFast;
  const Progress progress = options.progress;
  double done = 0;
  const auto next_part = [&] {
    const double before = done;
    done += 1.0 / (std::size(kStepsToTry) + 1);
    return progress.part(before, done);
  };
  options.progress = next_part();
  const auto bytes_of = [&](const Tin& tin) { return encode(tin, {}, options.effort).size(); };
  const Decimal own = lay_out(part, lattice).z_step;
  const auto with_step = [&](int hundredths) {
    LatticeOptions with = lattice;
    with.z_step = step_near(own, lattice.never_below ? half(least) : least, hundredths);
    return with;
  };
  const Approximation stream =
      approximate(part, has_lines ? with_step(kFineStep) : lattice, options);
  const bool is_fine_enough = part.bounds.empty() || stream.laid.z_step <= least;
  Decimal best = stream.laid.z_step;
  std::size_t fewest = is_fine_enough ? bytes_of(stream.tin) : SIZE_MAX;
  for (const int hundredths : kStepsToTry) {
    const LatticeOptions with = with_step(hundredths);
    options.progress = next_part();
    if (*with.z_step == best) continue;
    const std::size_t bytes = bytes_of(approximate(part, with, options).tin);
    if (bytes >= fewest) continue;
    fewest = bytes;
    best = *with.z_step;
  }
  return best;
}

// Chooses the heights' lattice for all tiles.
TiledRaster tiled_raster(const RasterReader& raster, const RasterScan& scanned,
                         const PackOptions& options, const Progress& progress) {
  LatticeOptions kept = options.lattice;
  kept.breaklines.clear();
  LatticeOptions lattice = first_fit(kept);
  const Raster& frame = raster.frame();
  if (options.simplify.bounded && !lattice.z_step && !scanned.has_exact_posts) {
    try {
      SimplifyOptions simplify = options.simplify;
      simplify.progress = progress;
      lattice.z_step = choose_z_step(raster.read(scanned.roughest), *scanned.least_bound,
                                     !options.lattice.breaklines.empty(), lattice, simplify);
      kept.z_step = lattice.z_step;
      return {raster, choose_post_lattice(frame, scanned.heights, lattice), kept, {}};
    } catch (const Error&) {  // too little terrain there, or too fine for the whole
      lattice.z_step.reset();
    }
  }
  return {raster, choose_post_lattice(frame, scanned.heights, lattice), kept, {}};
}

// Puts tiles that are encoded in any order into that of their numbers.
class InOrder {
 public:
  InOrder(uint32_t first, const TakeTile& take) : next_(first), take_(take) {}

  void add(uint32_t tile, EncodedTile&& encoded) {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.emplace(tile, std::move(encoded));
    for (; !waiting_.empty() && waiting_.begin()->first == next_; ++next_) {
      take_(next_, std::move(waiting_.begin()->second));
      waiting_.erase(waiting_.begin());
    }
  }

 private:
  std::mutex mutex_;
  std::map<uint32_t, EncodedTile> waiting_;
  uint32_t next_;
  const TakeTile& take_;
};

}  // namespace

uint32_t most_vertices(const PackOptions& options, const TileGrid& grid) {
  const bool is_wide = grid.width > 255 || grid.height > 255;
  return is_wide && options.max_vertices_wide != 0 ? options.max_vertices_wide
                                                   : options.max_vertices;
}

bool fits(const TileSummary& tile, uint32_t most) {
  return !tile.compact || keeps_promise(*tile.compact, most);
}

PackPlan plan_pack(const RasterReader& raster, const PackOptions& options) {
  if (raster.frame().width < 2 || raster.frame().height < 2)
    throw Error("a pack needs two posts in each direction");
  if (is_bound_everywhere(options.lattice)) expect_equal_distances(raster.frame());
  expect_breaklines_possible(options.lattice, raster.frame());
  const Progress& progress = options.simplify.progress;
  const bool chooses_z_step = options.simplify.bounded && !options.lattice.z_step;
  const RasterScan scanned =
      scan(raster, options.lattice.max_error, chooses_z_step, progress.part(0, kScanPart));
  const double begun = chooses_z_step ? kStepPart : kScanPart;
  PackPlan plan{tiled_raster(raster, scanned, options, progress.part(kScanPart, begun)), options,
                options.tile_size, scanned.fingerprint, begun};
  plan.tiled.lines =
      tiled_lines(options.lattice.breaklines, plan.tiled.lattice.placement, raster.frame());
  if (plan.tile_size == 0) {
    plan.planned += (1 - begun) * counting_part(raster.frame(), options);
    plan.tile_size = choose_tile_size(plan.tiled, options, progress.part(begun, plan.planned));
  }
  plan.tiled.grid = grid_of(raster.frame(), plan.tile_size);
  return plan;
}

TileRange all_tiles(const TileGrid& grid) {
  return {0, static_cast<uint32_t>(tile_count(grid) - 1)};
}

TileTooLarge::TileTooLarge(uint32_t number, uint32_t count, uint32_t steps)
    : Error("tile " + std::to_string(number) + " has " + std::to_string(count) +
            " vertices, more than a tile may have; use " + parameter("tile_size") + ' ' +
            std::to_string(steps)),
      tile(number),
      vertices(count),
      fewer_steps(steps) {}

namespace {

// A tile of at most as many vertices as a tile may have, or one that is kept. Throws TileTooLarge.
EncodedTile encode_fitting(const PackPlan& plan, uint32_t tile, const SimplifyOptions& options) {
  const uint32_t most = most_vertices(plan.options, plan.tiled.grid);
  const bool is_kept = plan.tiled.kept != nullptr && plan.tiled.kept->keeps(tile);
  const auto is_fitting = [&](const TileSummary& summary) {
    return is_kept || (summary.vertices <= most && fits(summary, most));
  };
  EncodedTile encoded = encode_tile(plan.tiled, tile, options);
  if (is_fitting(encoded.summary)) return encoded;
  const uint32_t vertices = encoded.summary.vertices;
  if (long_search_may_fit(vertices, most, options)) {
    encoded = encode_tile(plan.tiled, tile, with_long_search(options));
    if (is_fitting(encoded.summary)) return encoded;
  }
  throw TileTooLarge(tile, vertices, smaller_tile_size(plan.tiled.grid, most, vertices));
}

}  // namespace

void encode_tiles(const PackPlan& plan, TileRange range, const TakeTile& take) {
  InOrder in_order(range.first, take);
  SimplifyOptions options = plan.options.simplify;
  const std::size_t count = std::size_t{range.last} - range.first + 1;
  CountedProgress done(options.progress.part(plan.planned, 1), count);
  options.progress = {};
  for_each_parallel(count, [&](std::size_t i) {
    const uint32_t tile = range.first + static_cast<uint32_t>(i);
    in_order.add(tile, encode_fitting(plan, tile, options));
    done.add_one();
  });
}

void encode_pack(const RasterReader& raster, const PackOptions& options, uint32_t tile_size,
                 const std::function<uint32_t(const PackPlan&)>& begin, const TakeTile& take) {
  PackOptions planned = options;
  if (options.tile_size == 0) planned.tile_size = tile_size;
  PackPlan plan = plan_pack(raster, planned);
  for (;;) {
    const uint32_t first = begin(plan), last = all_tiles(plan.tiled.grid).last;
    try {
      if (first <= last) encode_tiles(plan, {first, last}, take);
      return;
    } catch (const TileTooLarge& error) {  // the same one whatever the number of processors
      if (options.tile_size != 0) throw;
      plan.tile_size = error.fewer_steps;
      plan.tiled.grid = grid_of(raster.frame(), plan.tile_size);
    }
  }
}

}  // namespace microtin::pack
