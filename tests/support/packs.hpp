// SPDX-License-Identifier: MIT
// Rasters and their packs, for tests of both sides.
#ifndef MICROTIN_TESTS_SUPPORT_PACKS_HPP
#define MICROTIN_TESTS_SUPPORT_PACKS_HPP

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "encoder/pack/encode.hpp"
#include "encoder/pack/file.hpp"
#include "encoder/pack/surface.hpp"
#include "microtin/segment.h"
#include "tests/support/joined_pack.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/point_sets.hpp"

namespace microtin::tests {

using VoidAt = std::function<bool(int, int)>;

inline bool no_void(int, int) {
  return false;
}

// Row by row, row 0 southernmost.
inline Raster raster_of(uint32_t width, std::vector<int64_t> heights) {
  Raster raster;
  raster.width = width;
  raster.height = static_cast<uint32_t>(heights.size() / width);
  raster.heights = std::move(heights);
  return raster;
}

// Waves, a cliff and noise, in whole units.
inline Raster rough_raster(uint32_t width, uint32_t height, const VoidAt& void_at = no_void) {
  Raster raster;
  raster.width = width;
  raster.height = height;
  Random random(width + height);
  for (int y = 0; y < static_cast<int>(height); ++y) {
    for (int x = 0; x < static_cast<int>(width); ++x) {
      const double waves = 40 * std::sin(x * 0.11) + 30 * std::cos(y * 0.13 + x * 0.05);
      const int64_t cliff = x + 2 * y > 90 ? 30 : 0;
      const int64_t z = std::lround(waves) + cliff + random.below(3);
      raster.heights.push_back(void_at(x, y) ? kVoidHeight : z);
    }
  }
  return raster;
}

// A rough raster whose south-western tiles have no terrain.
inline Raster raster_with_hole() {
  return rough_raster(61, 53, [](int x, int y) { return x < 25 && y < 25; });
}

// The diagonal of all tiles.
inline microtin_segment whole(const TileGrid& grid) {
  return {0, 0, int64_t{grid.x_max} * 256, int64_t{grid.y_max} * 256};
}

inline PackOptions pack_options(int64_t bound, uint32_t max_vertices) {
  PackOptions options{{}, {}, max_vertices, 0};
  options.lattice.max_error = Decimal{bound, 0};
  options.simplify.bounded = true;
  options.simplify.search = Search::kFast;
  return options;
}

// A pack in memory.
struct EncodedPack {
  PackContent content;
  std::vector<std::vector<uint8_t>> streams;
};

inline EncodedPack encode_pack(const Raster& raster, const PackOptions& options) {
  EncodedPack pack;
  const auto begin = [&](const PackPlan& plan) {
    pack = {content_of(plan, {}), {}};
    return 0;
  };
  encode_pack(RasterInMemory(raster), options, 0, begin, [&](uint32_t, EncodedTile&& tile) {
    pack.content.tiles.push_back(tile.summary);
    pack.streams.push_back(std::move(tile.stream));
  });
  return pack;
}

inline std::vector<uint8_t> write_pack(const EncodedPack& pack) {
  return write_pack(pack.content, pack.streams);
}

inline std::vector<uint8_t> pack_bytes(const Raster& raster, int64_t bound = 3,
                                       uint32_t vertices = 40) {
  return write_pack(encode_pack(raster, pack_options(bound, vertices)));
}

using verifying::verify;  // which the function below would hide

inline Verification verify(const PackFile& pack, const Raster& raster,
                           const std::optional<Decimal>& bound) {
  return verify(pack, RasterInMemory(raster), bound);
}

// Holes of all kinds, for rasters of 61 x 53 posts in tiles of any size.
struct VoidKind {
  std::string name;
  VoidAt at;
};

inline std::vector<VoidKind> void_kinds() {
  const auto scattered = [](uint32_t percent) {
    return [percent](int x, int y) {
      return Random(static_cast<uint64_t>(x * 1000 + y)).below(100) < percent;
    };
  };
  return {
      {"none", no_void},
      {"one post", [](int x, int y) { return x == 31 && y == 17; }},
      {"rectangle", [](int x, int y) { return x > 14 && x < 35 && y > 10 && y < 30; }},
      {"disc", [](int x, int y) { return (x - 30) * (x - 30) + (y - 26) * (y - 26) < 150; }},
      {"diagonal stripe", [](int x, int y) { return std::abs(x - y) < 3; }},
      {"thin diagonal", [](int x, int y) { return x == y; }},
      {"row", [](int, int y) { return y == 26; }},
      {"columns beside a middle one", [](int x, int) { return x == 29 || x == 31; }},
      {"chessboard", [](int x, int y) { return (x + y) % 2 == 0; }},
      {"corner", [](int x, int y) { return x < 25 && y < 25; }},
      {"slanted corner", [](int x, int y) { return x + y < 33; }},
      {"half", [](int x, int) { return x > 30; }},
      {"all but a disc",
       [](int x, int y) { return (x - 30) * (x - 30) + (y - 26) * (y - 26) > 180; }},
      {"3 of 100", scattered(3)},
      {"30 of 100", scattered(30)},
  };
}

}  // namespace microtin::tests

#endif
