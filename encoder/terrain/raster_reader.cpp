// SPDX-License-Identifier: MIT
// A raster of which rectangles are read, so that the whole need not fit into memory.
#include "encoder/terrain/raster_reader.hpp"

#include <algorithm>
#include <utility>

#include "encoder/exact/fraction.hpp"
#include "encoder/terrain/voids.hpp"

namespace microtin::terrain {

Raster crop_frame(const Raster& raster, const PostRectangle& r) {
  Raster part;
  part.width = r.width;
  part.height = r.height;
  part.decimals = raster.decimals;
  part.x = moved_axis(raster.x, r.x);
  part.y = moved_axis(raster.y, r.y);
  part.reference = raster.reference;
  part.x_spacing = raster.x_spacing;
  part.y_spacing = raster.y_spacing;
  part.bounds = frame_of(raster.bounds);
  return part;
}

namespace {

// The numbers of a rectangle, row by row.
std::vector<int64_t> cropped(const std::vector<int64_t>& numbers, uint32_t width,
                             const PostRectangle& r) {
  std::vector<int64_t> part;
  part.reserve(std::size_t{r.width} * r.height);
  for (uint32_t row = r.y; row < r.y + r.height; ++row) {
    const auto begin =
        numbers.begin() + static_cast<std::ptrdiff_t>(std::size_t{row} * width + r.x);
    part.insert(part.end(), begin, begin + r.width);
  }
  return part;
}

}  // namespace

Raster crop(const Raster& raster, const PostRectangle& r) {
  Raster part = crop_frame(raster, r);
  part.heights = cropped(raster.heights, raster.width, r);
  if (!raster.bounds.empty()) part.bounds.numbers = cropped(raster.bounds.numbers, raster.width, r);
  return part;
}

Raster frame_of(const Raster& raster) {
  Raster frame;
  frame.width = raster.width;
  frame.height = raster.height;
  frame.decimals = raster.decimals;
  frame.x = raster.x;
  frame.y = raster.y;
  frame.reference = raster.reference;
  frame.x_spacing = raster.x_spacing;
  frame.y_spacing = raster.y_spacing;
  frame.bounds = frame_of(raster.bounds);
  return frame;
}

RasterInMemory::RasterInMemory(Raster raster) : raster_(std::move(raster)) {
  frame_ = frame_of(raster_);
}

namespace {

// A stretch of posts, wider by a margin where the raster has this many.
struct Stretch {
  uint32_t from, size;
};

Stretch widened(Stretch stretch, uint32_t margin, uint32_t all) {
  const uint32_t from = stretch.from - std::min(stretch.from, margin);
  const uint32_t end = stretch.from + stretch.size;
  return {from, end + std::min(all - end, margin) - from};
}

class FilledRaster : public RasterReader {
 public:
  FilledRaster(std::unique_ptr<RasterReader> raster, uint32_t largest)
      : raster_(std::move(raster)), largest_(largest) {
    frame_ = raster_->frame();
  }

  // A void is filled alike in every rectangle that holds it and what is next to it.
  Raster read(const PostRectangle& r) const override {
    for (uint32_t margin = 16;; margin *= 2) {
      const Stretch x = widened({r.x, r.width}, margin, frame_.width);
      const Stretch y = widened({r.y, r.height}, margin, frame_.height);
      Raster wide = raster_->read({x.from, y.from, x.size, y.size});
      const PostRectangle inner{r.x - x.from, r.y - y.from, r.width, r.height};
      if (is_cut(wide, x, y, inner)) continue;
      const uint64_t voids = void_posts(crop(wide, inner));
      fill_voids(wide, largest_);
      Raster part = crop_frame(frame_, r);
      part.heights = crop(wide, inner).heights;
      part.mended.filled = voids - void_posts(part);
      return part;
    }
  }

  std::vector<bool> absent_in(const PostRectangle& r) const override {
    return raster_->absent_in(r);
  }

 private:
  bool is_cut(const Raster& wide, Stretch x, Stretch y, const PostRectangle& inner) const {
    const Sides cut{x.from != 0, y.from != 0, x.from + x.size != frame_.width,
                    y.from + y.size != frame_.height};
    return reaches_side(wide, inner, cut, largest_);
  }

  std::unique_ptr<RasterReader> raster_;
  uint32_t largest_;
};

}  // namespace

std::unique_ptr<RasterReader> with_voids_filled(std::unique_ptr<RasterReader> raster,
                                                uint32_t largest) {
  if (largest == 0) return raster;
  return std::make_unique<FilledRaster>(std::move(raster), largest);
}

}  // namespace microtin::terrain
