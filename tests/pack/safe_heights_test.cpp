// SPDX-License-Identifier: MIT
// Safe heights of encoded packs hold the raster, interpolated bilinearly, everywhere.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/pack_device.hpp"
#include "tests/support/packs.hpp"

namespace microtin::tests {
namespace {

constexpr int kPackWidth = 61, kPackHeight = 53;

// The raster's surface at a position with 8 fractional bits, with 16 of them.
int64_t bilinear(const Raster& raster, int64_t x, int64_t y) {
  const int64_t column = std::min<int64_t>(x / 256, kPackWidth - 2),
                row = std::min<int64_t>(y / 256, kPackHeight - 2);
  const int64_t east = x - column * 256, north = y - row * 256;
  const auto post = [&](int64_t c, int64_t r) {
    return raster.heights[static_cast<size_t>(r * kPackWidth + c)];
  };
  return (256 - north) * ((256 - east) * post(column, row) + east * post(column + 1, row)) +
         north * ((256 - east) * post(column, row + 1) + east * post(column + 1, row + 1));
}

microtin_query_result safe_heights(const PackDevice& device, bool is_compact, int64_t x, int64_t y,
                                   microtin_safe_heights* heights) {
  uint32_t hint = 0;
  return is_compact ? microtin_compact_pack_safe_heights_at(device.pack, x, y, &hint, heights)
                    : microtin_pack_safe_heights_at(device.pack, x, y, &hint, heights);
}

}  // namespace

TEST_CASE("safe heights: a raster lies within those of its pack, also between posts") {
  constexpr int64_t kBoundSteps = 3;
  const Raster raster = rough_raster(kPackWidth, kPackHeight);
  Card card{pack_bytes(raster, kBoundSteps, 60)};
  const MeshSlots meshes(4);
  const CompactSlots rings(4);
  Random random(64);
  int beyond_bound = 0;
  for (int probe = 0; probe < 4000; ++probe) {
    const bool is_compact = probe % 2 != 0;
    const PackDevice& device = is_compact ? static_cast<const PackDevice&>(rings) : meshes;
    const int64_t x = random.below((kPackWidth - 1) * 256 + 1),
                  y = random.below((kPackHeight - 1) * 256 + 1);
    REQUIRE(device.load(card, {x, y, x, y}) == MICROTIN_STATUS_OK);
    microtin_pack_info info;
    REQUIRE(microtin_pack_get_info(device.pack, &info) == MICROTIN_STATUS_OK);
    microtin_safe_heights heights{};
    REQUIRE(safe_heights(device, is_compact, x, y, &heights) == MICROTIN_QUERY_OK);
    // In z steps with 16 fractional bits, times the numerator.
    const auto numerator = static_cast<int64_t>(info.z.numerator);
    const int64_t source =
        bilinear(raster, x, y) * static_cast<int64_t>(info.z.denominator) - info.z.offset * 65536;
    CHECK(int64_t{heights.lowest} * 256 * numerator <= source);
    CHECK(int64_t{heights.highest} * 256 * numerator >= source);
    int32_t height = 0;
    REQUIRE(device.height_at(x, y, height) == MICROTIN_QUERY_OK);
    const int64_t error = std::abs(height * numerator - source);
    if (error > kBoundSteps * 65536 * static_cast<int64_t>(info.z.denominator)) ++beyond_bound;
  }
  CHECK(beyond_bound > 20);  // where the bound alone would be no promise
}

}  // namespace microtin::tests
