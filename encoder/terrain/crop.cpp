// SPDX-License-Identifier: MIT
// Copies a rectangle out of a raster.
#include "encoder/terrain/crop.hpp"

#include "encoder/exact/fraction.hpp"

namespace microtin::terrain {

Raster crop_frame(const Raster& raster, const PostRectangle& r) {
  Raster part;
  part.width = r.width;
  part.height = r.height;
  part.decimals = raster.decimals;
  part.x = moved_axis(raster.x, r.x);
  part.y = moved_axis(raster.y, r.y);
  part.reference = raster.reference;
  return part;
}

Raster crop(const Raster& raster, const PostRectangle& r) {
  Raster part = crop_frame(raster, r);
  part.heights.reserve(std::size_t{r.width} * r.height);
  for (uint32_t row = r.y; row < r.y + r.height; ++row) {
    const auto begin =
        raster.heights.begin() + static_cast<std::ptrdiff_t>(std::size_t{row} * raster.width + r.x);
    part.heights.insert(part.heights.end(), begin, begin + r.width);
  }
  return part;
}

}  // namespace microtin::terrain
