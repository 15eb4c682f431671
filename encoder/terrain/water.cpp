// SPDX-License-Identifier: MIT
// Floods voids and checks masks.
#include "encoder/terrain/water.hpp"

#include <algorithm>

#include "encoder/base/error.hpp"
#include "encoder/exact/lattice_map.hpp"

namespace microtin::terrain {
namespace {

// Writes all heights with at least this many decimals.
void refine(Raster& raster, int decimals) {
  if (decimals <= raster.decimals) return;
  if (!terrain::refine(raster.heights, power_of_ten(decimals - raster.decimals))) {
    throw Error("the water level has too many decimals for these heights");
  }
  raster.decimals = decimals;
}

}  // namespace

void flood_voids(Raster& raster, Decimal level, const Raster* mask) {
  refine(raster, level.decimals);
  const std::optional<int64_t> height = number_of(level, raster.decimals);
  if (!height) throw Error("the water level is out of range");
  for (size_t i = 0; i < raster.heights.size(); ++i) {
    if (raster.heights[i] != kVoidHeight) continue;
    if (mask != nullptr && mask->heights[i] != power_of_ten(mask->decimals)) continue;
    raster.heights[i] = *height;
    ++raster.mended.flooded;
  }
}

void check_water_mask(const Raster& mask, const Raster& raster) {
  if (mask.width != raster.width || mask.height != raster.height || !is_same(mask.x, raster.x) ||
      !is_same(mask.y, raster.y)) {
    throw Error(
        "its grid differs from the terrain's; it must have the same columns, rows and cells");
  }
  const int64_t one = power_of_ten(mask.decimals);
  const bool is_mask = std::all_of(mask.heights.begin(), mask.heights.end(), [&](int64_t value) {
    return value == 0 || value == one || value == kVoidHeight;
  });
  if (!is_mask) throw Error("a water mask contains only 0 and 1");
}

}  // namespace microtin::terrain
