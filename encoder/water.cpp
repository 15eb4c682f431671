#include "encoder/water.hpp"

#include <algorithm>

#include "encoder/error.hpp"
#include "encoder/lattice_map.hpp"

namespace microtin {
namespace {

bool is_same(const Axis& a, const Axis& b) {
  const LatticeMap map = map_between(a, b);
  return map.shift == 0 && map.scale == map.step;
}

// Writes all heights with so many decimals at least.
void refine(Raster& raster, int decimals) {
  constexpr int64_t kLargest = 1000000000000000000;
  if (decimals <= raster.decimals) return;
  const int64_t factor = power_of_ten(decimals - raster.decimals);
  for (int64_t& height : raster.heights) {
    if (height == kVoidHeight) continue;
    if (magnitude(height) > kLargest / factor) {
      throw Error("the water level has too many decimals beside such heights");
    }
    height *= factor;
  }
  raster.decimals = decimals;
}

}  // namespace

uint32_t flood_voids(Raster& raster, Decimal level, const Raster* mask) {
  constexpr Wide kLargest = 1000000000000000000;
  refine(raster, level.decimals);
  const Wide height = mantissa_at(level, raster.decimals);
  if (magnitude(height) > kLargest) throw Error("the water level is out of range");
  uint32_t flooded = 0;
  for (size_t i = 0; i < raster.heights.size(); ++i) {
    if (raster.heights[i] != kVoidHeight) continue;
    if (mask != nullptr && mask->heights[i] != power_of_ten(mask->decimals)) continue;
    raster.heights[i] = static_cast<int64_t>(height);
    ++flooded;
  }
  return flooded;
}

void check_water_mask(const Raster& mask, const Raster& raster) {
  if (mask.width != raster.width || mask.height != raster.height || !is_same(mask.x, raster.x) ||
      !is_same(mask.y, raster.y)) {
    throw Error("has not the posts of the terrain");
  }
  const int64_t one = power_of_ten(mask.decimals);
  const bool is_mask = std::all_of(mask.heights.begin(), mask.heights.end(), [&](int64_t value) {
    return value == 0 || value == one || value == kVoidHeight;
  });
  if (!is_mask) throw Error("a mask holds 0 and 1 only");
}

}  // namespace microtin
