// SPDX-License-Identifier: MIT
// Small packs of random tiles, and segments through packs.
#ifndef MICROTIN_TESTS_SUPPORT_PACK_SEGMENTS_HPP
#define MICROTIN_TESTS_SUPPORT_PACK_SEGMENTS_HPP

#include <vector>

#include "tests/support/forged_pack.hpp"

namespace microtin::tests {

// Segments of all kinds: any, between lattice places, along lines of them, along borders, places.
inline microtin_segment any_segment(Random& random, const TileGrid& grid) {
  const auto pick = [&](uint32_t most) {
    return static_cast<int64_t>(random.below(most * 256 + 1));
  };
  microtin_segment c = {pick(grid.x_max), pick(grid.y_max), pick(grid.x_max), pick(grid.y_max)};
  const uint32_t kind = random.below(8);
  const auto whole = [](int64_t& v, int64_t unit) { v = v / unit * unit; };
  if (kind != 0) {
    const int64_t unit = kind == 1 ? 128 : 256;
    for (int64_t* v : {&c.x, &c.y, &c.x_end, &c.y_end}) whole(*v, unit);
  }
  if (kind == 2 || kind == 3) c.x_end = c.x;
  if (kind == 3) whole(c.x, int64_t{grid.width} * 256), c.x_end = c.x;
  if (kind == 4 || kind == 5) c.y_end = c.y;
  if (kind == 5) whole(c.y, int64_t{grid.height} * 256), c.y_end = c.y;
  if (kind == 6) c.x_end = c.x, c.y_end = c.y;
  if (kind == 7 && random.below(2) == 0) {  // on a border line, between lattice places
    c = {c.x, pick(grid.y_max), c.x, pick(grid.y_max)};
    whole(c.x, int64_t{grid.width} * 256), c.x_end = c.x;
  }
  return c;
}

// Tiles of random vertices, some of them without terrain, which disagree along their borders.
inline Bytes random_pack(Random& random) {
  const uint16_t width = static_cast<uint16_t>(1 + random.below(5)),
                 height = static_cast<uint16_t>(1 + random.below(5));
  const TileGrid grid = {2u * width + random.below(2) * 2, 2u * height, width, height};
  std::vector<ForgedTile> tiles;
  for (uint32_t tile = 0; tile < tile_columns(grid) * tile_rows(grid); ++tile) {
    const TileBox box = tile_box(grid, tile);
    const bool is_whole = random.below(3) != 0 || box.x_end - box.x + box.y_end - box.y < 4;
    tiles.push_back(random.below(8) == 0
                        ? ForgedTile()
                        : forged_tile(random_tile(random, box.x_end - box.x, box.y_end - box.y,
                                                  is_whole, random.below(3) * 20)));
  }
  return forged_pack(grid, tiles);
}

}  // namespace microtin::tests

#endif
