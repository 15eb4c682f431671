// SPDX-License-Identifier: MIT
// A raster of which rectangles are read, so that the whole need not fit into memory.
#ifndef MICROTIN_ENCODER_TERRAIN_RASTER_READER_HPP
#define MICROTIN_ENCODER_TERRAIN_RASTER_READER_HPP

#include <memory>
#include <utility>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::terrain {

// Columns and rows of posts, all within the raster.
struct PostRectangle {
  uint32_t x, y, width, height;
};

// The posts of a rectangle, at the same real coordinates. Throws Error if an axis cannot say these.
Raster crop(const Raster& raster, const PostRectangle& rectangle);

// Crops a raster without its heights.
Raster crop_frame(const Raster& raster, const PostRectangle& rectangle);

// Reading from several threads at once is allowed.
class RasterReader {
 public:
  RasterReader() = default;
  RasterReader(const RasterReader&) = delete;
  RasterReader& operator=(const RasterReader&) = delete;
  virtual ~RasterReader() = default;

  // The raster without its heights.
  const Raster& frame() const { return frame_; }

  // The posts of a rectangle within the raster, at their real coordinates. Throws Error.
  virtual Raster read(const PostRectangle& rectangle) const = 0;

  // Which places of a rectangle, row by row, are in none of the files that the raster consists of.
  // Empty: all are in one.
  virtual std::vector<bool> absent_in(const PostRectangle&) const { return {}; }

 protected:
  Raster frame_;
};

// A raster without its heights.
Raster frame_of(const Raster& raster);

class RasterInMemory : public RasterReader {
 public:
  explicit RasterInMemory(Raster raster);

  Raster read(const PostRectangle& rectangle) const override { return crop(raster_, rectangle); }

 private:
  Raster raster_;
};

// The raster with its small voids filled as fill_voids does. Memory and time of a rectangle grow
// with the extent of the small voids in it.
std::unique_ptr<RasterReader> with_voids_filled(std::unique_ptr<RasterReader> raster,
                                                uint32_t largest);

}  // namespace microtin::terrain

#endif
