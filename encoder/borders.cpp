#include "encoder/borders.hpp"

#include <algorithm>
#include <cstddef>

#include "encoder/crop.hpp"
#include "encoder/parallel.hpp"

namespace microtin {
namespace {

// The tiles in one direction that hold a coordinate.
std::vector<uint32_t> slices_at(uint32_t k, uint32_t size, uint32_t slices) {
  const uint32_t slice = k / size;
  std::vector<uint32_t> found;
  if (k % size == 0 && slice > 0) found.push_back(slice - 1);
  if (slice < slices) found.push_back(slice);
  return found;
}

uint32_t along(const TileBox& line, GlobalPost post) {
  return (post.x - line.x) + (post.y - line.y);
}

GlobalPost post_of(const TileBox& line, uint32_t post) {
  return line.x == line.x_end ? GlobalPost{line.x, line.y + post}
                              : GlobalPost{line.x + post, line.y};
}

}  // namespace

Raster crop(const Raster& raster, const TileBox& box) {
  return crop(raster, PostRectangle{box.x, box.y, box.x_end - box.x + 1, box.y_end - box.y + 1});
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

Borders::Borders(const TiledRaster& tiled) : tiled_(tiled) {
  const TileGrid& grid = tiled.grid;
  for (uint32_t tile = 0; tile < tile_columns(grid) * tile_rows(grid); ++tile) {
    const TileBox box = tile_box(grid, tile);
    if (box.x != 0) {
      north_[{box.x, box.y}] = lines_.size();
      lines_.push_back({{box.x, box.y, box.x, box.y_end}, {}, {}});
    }
    if (box.y != 0) {
      east_[{box.x, box.y}] = lines_.size();
      lines_.push_back({{box.x, box.y, box.x_end, box.y}, {}, {}});
    }
  }
  for_each_parallel(lines_.size(), [this](std::size_t i) { simplify(lines_[i]); });
}

void Borders::simplify(Line& line) const {
  std::vector<LinePost> posts(along(line.box, {line.box.x_end, line.box.y_end}) + 1);
  for (const Sample& sample : survey_of(tiled_, crop(tiled_.raster, line.box)).samples) {
    posts[std::size_t{sample.place.x} + sample.place.y].sample = sample;
  }
  for (const uint32_t post : line.kept) posts[post].kept = true;
  line.chain = simplify_line(posts, ErrorModel{tiled_.options.max_error.has_value()});
}

SharedVertices Borders::of_tile(uint32_t tile) const {
  const TileBox box = tile_box(tiled_.grid, tile);
  SharedVertices shared;
  const auto add = [&](const std::map<GlobalPost, std::size_t>& lines, GlobalPost first) {
    const auto found = lines.find(first);
    if (found == lines.end()) return;
    const Line& line = lines_[found->second];
    for (const ChainVertex& vertex : line.chain) {
      const GlobalPost post = post_of(line.box, vertex.post);
      shared[{static_cast<uint16_t>(post.x - box.x), static_cast<uint16_t>(post.y - box.y)}] =
          vertex.height;
    }
  };
  add(north_, {box.x, box.y});
  add(north_, {box.x_end, box.y});
  add(east_, {box.x, box.y});
  add(east_, {box.x, box.y_end});
  return shared;
}

std::set<uint32_t> Borders::keep(const std::vector<GlobalPost>& posts) {
  std::set<uint32_t> tiles;
  std::set<std::size_t> changed;
  for (const GlobalPost post : posts) {
    for (const std::size_t i : lines_at(post)) {
      Line& line = lines_[i];
      line.kept.insert(along(line.box, post));
      changed.insert(i);
    }
  }
  const std::vector<std::size_t> lines(changed.begin(), changed.end());
  for_each_parallel(lines.size(), [&](std::size_t i) { simplify(lines_[lines[i]]); });
  for (const std::size_t i : lines) {
    const TileBox& box = lines_[i].box;
    const GlobalPost within = post_of(box, 1);
    for (const uint32_t tile : tiles_at(tiled_.grid, within)) tiles.insert(tile);
    for (const uint32_t tile : tiles_at(tiled_.grid, {box.x, box.y})) tiles.insert(tile);
    for (const uint32_t tile : tiles_at(tiled_.grid, {box.x_end, box.y_end})) tiles.insert(tile);
  }
  return tiles;
}

// Corners belong to several, but are vertices of all of them already.
std::vector<std::size_t> Borders::lines_at(GlobalPost post) const {
  const uint32_t x = post.x / tiled_.grid.width * tiled_.grid.width;
  const uint32_t y = post.y / tiled_.grid.height * tiled_.grid.height;
  std::vector<std::size_t> found;
  const auto north = north_.find({x, y}), east = east_.find({x, y});
  if (post.x == x && post.y != y && north != north_.end()) found.push_back(north->second);
  if (post.y == y && post.x != x && east != east_.end()) found.push_back(east->second);
  return found;
}

}  // namespace microtin
