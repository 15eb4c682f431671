// SPDX-License-Identifier: MIT
// Reads a tile with the posts beside it, and finds the vertices of its four borders.
#include "encoder/pack/borders.hpp"

#include <algorithm>
#include <cstddef>

#include "encoder/pack/border_line.hpp"
#include "encoder/pack/ground.hpp"

namespace microtin::pack {
namespace {

// The tiles in one direction that hold a coordinate.
std::vector<uint32_t> slices_at(uint32_t k, uint32_t size, uint32_t slices) {
  const uint32_t slice = k / size;
  std::vector<uint32_t> found;
  if (k % size == 0 && slice > 0) found.push_back(slice - 1);
  if (slice < slices) found.push_back(slice);
  return found;
}

GlobalPost post_of(const TileBox& line, uint32_t post) {
  return line.x == line.x_end ? GlobalPost{line.x, line.y + post}
                              : GlobalPost{line.x + post, line.y};
}

// A tile's sides that are borders, each from its first corner northwards or eastwards.
std::vector<TileBox> border_lines(const TileGrid& grid, const TileBox& box) {
  std::vector<TileBox> lines;
  if (box.x != 0) lines.push_back({box.x, box.y, box.x, box.y_end});
  if (box.x_end != grid.x_max) lines.push_back({box.x_end, box.y, box.x_end, box.y_end});
  if (box.y != 0) lines.push_back({box.x, box.y, box.x_end, box.y});
  if (box.y_end != grid.y_max) lines.push_back({box.x, box.y_end, box.x_end, box.y_end});
  return lines;
}

// A line and the posts around it on which its aims depend.
TileBox around(const TileGrid& grid, const TileBox& line) {
  return {line.x - std::min(line.x, kGroundReach), line.y - std::min(line.y, kGroundReach),
          std::min(line.x_end + kGroundReach, grid.x_max),
          std::min(line.y_end + kGroundReach, grid.y_max)};
}

constexpr uint32_t kVertexPrice = 2;  // dearer ones make ridges of noisy borders

// Aims at the ground on both sides: a border that follows the noise of its own posts stands out.
std::vector<LinePost> posts_of_line(const TiledRaster& tiled, const TilePosts& posts,
                                    const TileBox& line) {
  std::vector<LinePost> on_line((line.x_end - line.x) + (line.y_end - line.y) + 1);
  const TileBox strip = around(tiled.grid, line);
  const Ground ground(survey_of(tiled, posts.crop_of(strip)).samples, strip.x_end - strip.x + 1,
                      strip.y_end - strip.y + 1);
  for (const Sample& sample : survey_of(tiled, posts.crop_of(line)).samples) {
    const uint32_t post = uint32_t{sample.place.x} + sample.place.y;
    const GlobalPost place = post_of(line, post);
    const int64_t bounds = int64_t{sample.highest} - sample.lowest;
    on_line[post] = {sample, posts.is_beside_void(place.x, place.y),
                     ground.at(place.x - strip.x, place.y - strip.y, bounds / 8)};
  }
  return on_line;
}

}  // namespace

TilePosts::TilePosts(const TiledRaster& tiled, uint32_t tile)
    : box_(tile_box(tiled.grid, tile)),
      x_(box_.x - std::min(box_.x, kGroundReach)),
      y_(box_.y - std::min(box_.y, kGroundReach)) {
  const uint32_t x_end = std::min(box_.x_end + kGroundReach, tiled.grid.x_max);
  const uint32_t y_end = std::min(box_.y_end + kGroundReach, tiled.grid.y_max);
  posts_ = tiled.raster.read({x_, y_, x_end - x_ + 1, y_end - y_ + 1});
}

Raster TilePosts::crop_of(const TileBox& box) const {
  return crop(posts_, {box.x - x_, box.y - y_, box.x_end - box.x + 1, box.y_end - box.y + 1});
}

bool TilePosts::is_beside_void(uint32_t x, uint32_t y) const {
  const uint32_t column = x - x_, row = y - y_;
  for (uint32_t r = row - std::min(row, 1u); r <= std::min(row + 1, posts_.height - 1); ++r) {
    for (uint32_t c = column - std::min(column, 1u); c <= std::min(column + 1, posts_.width - 1);
         ++c) {
      if (posts_.heights[std::size_t{r} * posts_.width + c] == kVoidHeight) return true;
    }
  }
  return false;
}

Survey survey_of(const TiledRaster& tiled, const Raster& part) {
  Lattice lattice = tiled.lattice;
  lattice.placement.x = part.x;
  lattice.placement.y = part.y;
  return lay_out(part, lattice, tiled.options).survey;
}

std::vector<uint32_t> tiles_at(const TileGrid& grid, GlobalPost post) {
  const uint32_t columns = tile_columns(grid);
  std::vector<uint32_t> tiles;
  for (const uint32_t row : slices_at(post.y, grid.height, tile_rows(grid))) {
    for (const uint32_t column : slices_at(post.x, grid.width, columns)) {
      tiles.push_back(row * columns + column);
    }
  }
  return tiles;
}

SharedVertices shared_vertices(const TiledRaster& tiled, const TilePosts& posts) {
  const TileBox& box = posts.box();
  SharedVertices shared;
  for (const TileBox& line : border_lines(tiled.grid, box)) {
    const std::vector<LinePost> on_line = posts_of_line(tiled, posts, line);
    const ErrorModel model{tiled.options.max_error.has_value()};
    for (const ChainVertex& vertex : simplify_line(on_line, model, kVertexPrice)) {
      const GlobalPost post = post_of(line, vertex.post);
      shared[{static_cast<uint16_t>(post.x - box.x), static_cast<uint16_t>(post.y - box.y)}] =
          vertex.height;
    }
  }
  return shared;
}

}  // namespace microtin::pack
