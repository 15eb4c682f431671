// SPDX-License-Identifier: MIT
// Which tiles a segment meets.
#include "decoder/touched_tiles.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "tests/support/point_sets.hpp"

namespace microtin::tests {
namespace {

__extension__ typedef __int128 Wide;

// Whether a segment meets a closed box, in exact fractions: the part of it within each slab.
bool meets(const microtin_segment& c, const TileBox& box) {
  Wide from = 0, to = 1, whole = 1;  // from / whole .. to / whole of the way
  const auto clip = [&](int64_t begin, int64_t end, int64_t low, int64_t high) {
    if (begin > end) {
      const int64_t mirrored = -low;
      begin = -begin;
      end = -end;
      low = -high;
      high = mirrored;
    }
    if (begin == end) return low <= begin && begin <= high;
    const Wide length = end - begin;
    from = std::max(from * length, (low - begin) * whole);
    to = std::min(to * length, (high - begin) * whole);
    whole *= length;
    return from <= to;
  };
  return clip(c.x, c.x_end, int64_t{box.x} * 256, int64_t{box.x_end} * 256) &&
         clip(c.y, c.y_end, int64_t{box.y} * 256, int64_t{box.y_end} * 256);
}

std::vector<uint32_t> touched(const TileGrid& grid, const microtin_segment& segment) {
  std::vector<uint32_t> tiles;
  for (TouchedTiles t(grid, segment); !t.at_end(); t.next()) tiles.push_back(t.number());
  return tiles;
}

// Often on borders and corners, often outside.
int64_t coordinate(Random& random, uint32_t most) {
  const int64_t anywhere = static_cast<int64_t>(random.below(most * 512 + 1)) - most * 128;
  return random.below(2) == 0 ? anywhere : anywhere / 256 * 256;
}

}  // namespace

TEST_CASE("touched tiles: all that meet the segment, each once, from where it begins") {
  Random random(11);
  for (int i = 0; i < 20000; ++i) {
    const TileGrid grid = {1 + random.below(12), 1 + random.below(12),
                           static_cast<uint16_t>(1 + random.below(4)),
                           static_cast<uint16_t>(1 + random.below(4))};
    microtin_segment c = {coordinate(random, grid.x_max), coordinate(random, grid.y_max),
                          coordinate(random, grid.x_max), coordinate(random, grid.y_max)};
    if (i % 5 == 0) c.x_end = c.x;
    if (i % 7 == 0) c.y_end = c.y;
    std::vector<uint32_t> found = touched(grid, c), expected;
    for (uint32_t tile = 0; tile < tile_columns(grid) * tile_rows(grid); ++tile) {
      if (meets(c, tile_box(grid, tile))) expected.push_back(tile);
    }
    if (!found.empty() && meets({c.x, c.y, c.x, c.y}, {0, 0, grid.x_max, grid.y_max})) {
      CHECK(meets({c.x, c.y, c.x, c.y}, tile_box(grid, found.front())));
    }
    std::sort(found.begin(), found.end());
    REQUIRE(found == expected);
  }
}

TEST_CASE("touched tiles: a walk that is sent to a tile goes on as if it had come there") {
  Random random(12);
  for (int i = 0; i < 3000; ++i) {
    const TileGrid grid = {1 + random.below(12), 1 + random.below(12),
                           static_cast<uint16_t>(1 + random.below(4)),
                           static_cast<uint16_t>(1 + random.below(4))};
    const microtin_segment c = {coordinate(random, grid.x_max), coordinate(random, grid.y_max),
                                coordinate(random, grid.x_max), coordinate(random, grid.y_max)};
    const std::vector<uint32_t> all = touched(grid, c);
    const uint32_t tiles = tile_columns(grid) * tile_rows(grid);
    for (uint32_t tile = 0; tile < tiles + 3; ++tile) {
      TouchedTiles walk(grid, c);
      const auto met = std::find(all.begin(), all.end(), tile);
      REQUIRE(walk.go_to(tile) == (met != all.end()));
      std::vector<uint32_t> rest;
      for (; !walk.at_end(); walk.next()) rest.push_back(walk.number());
      REQUIRE(rest == std::vector<uint32_t>(met, all.end()));
    }
  }
}

TEST_CASE("pack: a segment across 2^32 tiles is looked along, not around") {
  const TileGrid grid = {65535, 65535, 1, 1};
  const int64_t far = 65535 * 256;
  CHECK(touched(grid, {0, 0, far, far}).size() == 3 * 65535 - 2);  // with those it meets at corners
  CHECK(touched(grid, {far, 7, 0, 7}).size() == 65535);
  CHECK(touched(grid, {7, far, 7, 0}).size() == 65535);
  // It leaves at a third of its height; one box more where it begins, changes column, and ends.
  CHECK(touched(grid, {far - 512, 0, far + 1024, far}).size() == 65535 / 3 + 3);
  CHECK(touched(grid, {far / 2, -far / 2 - 999, far + far / 2, far / 2 - 999})
            .empty());  // outside it
}

}  // namespace microtin::tests
