// SPDX-License-Identifier: MIT
// Goes over a raster in blocks: range of heights, fingerprint, the roughest block.
#include "encoder/terrain/raster_scan.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "encoder/base/work.hpp"

namespace microtin::terrain {
namespace {

constexpr uint32_t kBlock = 257;  // posts on each side

// A raster without the columns and rows that have no post. Of several grids, places remain that
// have none.
Raster without_gaps(const Raster& raster) {
  std::vector<bool> has_column(raster.width), has_row(raster.height);
  for_each_post(raster, [&](int64_t x, int64_t y, int64_t) {
    has_column[static_cast<std::size_t>(x)] = has_row[static_cast<std::size_t>(y)] = true;
  });
  Raster dense;
  dense.width = static_cast<uint32_t>(std::count(has_column.begin(), has_column.end(), true));
  dense.height = static_cast<uint32_t>(std::count(has_row.begin(), has_row.end(), true));
  dense.decimals = raster.decimals;
  dense.bounds = frame_of(raster.bounds);
  for (std::size_t i = 0; i < raster.heights.size(); ++i) {
    if (!has_column[i % raster.width] || !has_row[i / raster.width]) continue;
    dense.heights.push_back(raster.heights[i]);
    if (!raster.bounds.empty()) dense.bounds.numbers.push_back(raster.bounds.numbers[i]);
  }
  return dense;
}

// The posts of a grid whose every second one is known: how many of the others interpolation misses.
class Octave {
 public:
  Octave(const Raster& part, Decimal max_error)
      : part_(part),
        bound_of_(part.bounds, max_error, kMaxDecimals),
        of_height_(power_of_ten(std::max(0, kMaxDecimals - part.decimals))),
        of_bound_(2 * Wide{power_of_ten(std::max(0, part.decimals - kMaxDecimals))}) {}

  uint64_t misses(uint32_t step) const {
    uint64_t count = 0;
    for (uint32_t y = 0; y < part_.height; y += step) {
      for (uint32_t x = 0; x < part_.width; x += step) {
        const uint32_t dx = x / step % 2 * step, dy = y / step % 2 * step;
        if (dx != 0 || dy != 0) count += misses(x, y, dx, dy, step);
      }
    }
    return count;
  }

 private:
  bool misses(uint32_t x, uint32_t y, uint32_t dx, uint32_t dy, uint32_t step) const {
    if (x + dx >= part_.width || y + dy >= part_.height) return false;
    const int64_t here = height(x, y), before = height(x - dx, y - dy),
                  after = height(x + dx, y + dy);
    if (here == kNoPost || before == kNoPost || after == kNoPost) return false;
    const bool is_rim = before == kVoidHeight || after == kVoidHeight;
    if (here == kVoidHeight || is_rim) return here != kVoidHeight && step == 1;
    const Wide bound = bound_of_(std::size_t{y} * part_.width + x);
    return bound != BoundOf::kNone &&
           magnitude(2 * Wide{here} - before - after) * of_height_ > bound * of_bound_;
  }

  int64_t height(uint32_t x, uint32_t y) const {
    return part_.heights[std::size_t{y} * part_.width + x];
  }

  const Raster& part_;
  BoundOf bound_of_;
  Wide of_height_, of_bound_;  // units, twice that of bounds
};

struct BlockScan {
  uint64_t posts, voids;
  Mended mended;
  NumberRange heights;
  Extremes extremes;
  uint64_t fingerprint;
  uint64_t roughness;
  bool has_exact_posts;
  std::optional<Decimal> least_bound;
};

BlockScan scan_block(const Raster& block) {
  BlockScan result{};
  result.posts = posts_with_height(block);
  result.voids = void_posts(block);
  result.mended = block.mended;
  for (const int64_t height : block.heights) {
    if (is_height(height)) {
      result.heights.add(height);
      result.extremes.add(height);
    }
    result.fingerprint = mixed(result.fingerprint, static_cast<uint64_t>(height));
  }
  for (const int64_t bound : block.bounds.numbers) {
    result.fingerprint = mixed(result.fingerprint, static_cast<uint64_t>(bound));
    result.has_exact_posts = result.has_exact_posts || bound == 0;
  }
  return result;
}

}  // namespace

uint64_t roughness(const Raster& part, const std::optional<Decimal>& max_error) {
  if (!max_error) return posts_with_height(part);
  if (is_sparse(part)) return roughness(without_gaps(part), max_error);
  const Octave octave(part, *max_error);
  uint64_t count = 0;
  for (uint32_t step = 1; step < std::max(part.width, part.height); step *= 2) {
    count += octave.misses(step);
  }
  return count;
}

RasterScan scan(const RasterReader& raster, const std::optional<Decimal>& max_error,
                bool wants_roughest, const Progress& progress) {
  const Raster& frame = raster.frame();
  const uint32_t columns = (frame.width - 1) / kBlock + 1, rows = (frame.height - 1) / kBlock + 1;
  const auto box = [&](std::size_t i) {
    const uint32_t x = static_cast<uint32_t>(i % columns) * kBlock;
    const uint32_t y = static_cast<uint32_t>(i / columns) * kBlock;
    return PostRectangle{x, y, std::min(kBlock, frame.width - x),
                         std::min(kBlock, frame.height - y)};
  };
  std::vector<BlockScan> blocks(std::size_t{columns} * rows);
  CountedProgress done(progress, blocks.size());
  for_each_parallel(blocks.size(), [&](std::size_t i) {
    const Raster block = raster.read(box(i));
    blocks[i] = scan_block(block);
    if (wants_roughest) blocks[i].roughness = roughness(block, max_error);
    if (max_error) blocks[i].least_bound = least_bound(block.bounds, *max_error);
    done.add_one();
  });
  RasterScan all;
  all.mended = frame.mended;
  std::size_t roughest = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    all.posts += blocks[i].posts;
    all.voids += blocks[i].voids;
    all.mended.add(blocks[i].mended);
    all.heights.add(blocks[i].heights);
    all.extremes.add(blocks[i].extremes);
    if (blocks[i].roughness > blocks[roughest].roughness) roughest = i;
    all.fingerprint = mixed(all.fingerprint, blocks[i].fingerprint);
    all.has_exact_posts = all.has_exact_posts || blocks[i].has_exact_posts;
    const std::optional<Decimal>& least = blocks[i].least_bound;
    if (least && (!all.least_bound || *least <= *all.least_bound)) all.least_bound = least;
  }
  all.roughest = box(roughest);
  return all;
}

}  // namespace microtin::terrain
