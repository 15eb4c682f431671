// SPDX-License-Identifier: MIT
// A rectangle of a raster.
#ifndef MICROTIN_ENCODER_TERRAIN_CROP_HPP
#define MICROTIN_ENCODER_TERRAIN_CROP_HPP

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

}  // namespace microtin::terrain

#endif
