// SPDX-License-Identifier: MIT
// Reads rectangles of a raster in memory.
#include "encoder/terrain/raster_reader.hpp"

#include <utility>

namespace microtin::terrain {

Raster frame_of(const Raster& raster) {
  Raster frame;
  frame.width = raster.width;
  frame.height = raster.height;
  frame.decimals = raster.decimals;
  frame.x = raster.x;
  frame.y = raster.y;
  frame.reference = raster.reference;
  return frame;
}

RasterInMemory::RasterInMemory(Raster raster) : raster_(std::move(raster)) {
  frame_ = frame_of(raster_);
}

}  // namespace microtin::terrain
