// SPDX-License-Identifier: MIT
// Parts of packs: whole tiles are taken out, and put together again, without encoding.
#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/pack/tile.hpp"
#include "encoder/product/document.hpp"
#include "encoder/product/made_pack.hpp"
#include "encoder/terrain/exact_query.hpp"

namespace microtin::product {
namespace {

// A tile as the pack has it. What the whole pack states of errors stands for those of each tile.
TileSummary summary_of(const PackFile& pack, uint32_t tile, const std::vector<uint8_t>& stream,
                       DecodedTerrain&& decoded) {
  Verification stated;
  stated.posts = stated.covered = 1;
  const Metadata& metadata = pack.metadata();
  if (metadata.accuracy) {
    stated.max_error = metadata.accuracy->max_error;
    stated.rms_error = metadata.accuracy->rms_error;
    stated.mean_error = metadata.accuracy->mean_error;
  }
  const Decimal most = stated.max_error;
  stated.max_below = metadata.at_samples ? metadata.at_samples->below : most;
  stated.max_above = metadata.at_samples ? metadata.at_samples->above : most;
  TileSummary summary = pack::summary_of(stream, std::move(decoded), stated);
  const Margins margins = pack.margins(tile);
  summary.below = margins.below;
  summary.above = margins.above;
  return summary;
}

// What a pack of other tiles says of the same terrain: its first place is at (x, y) of `of`.
Metadata metadata_at(const Metadata& of, int64_t x, int64_t y, const TileGrid& grid) {
  Metadata metadata = of;
  metadata.placement.x = moved_axis(of.placement.x, x);
  metadata.placement.y = moved_axis(of.placement.y, y);
  if (of.grid) {
    metadata.grid =
        PostGrid{grid.x_max + 1, grid.y_max + 1, metadata.placement.x, metadata.placement.y};
  }
  metadata.places.clear();  // what the file had behind the pack
  return metadata;
}

// The first and the last slice of tiles that an extent has places of.
struct Slices {
  uint32_t first, last;
};

std::optional<Slices> slices_of(const Axis& axis, Decimal low, Decimal high, uint32_t end,
                                uint32_t size, uint32_t count) {
  const auto from = coordinate_of(low, axis), to = coordinate_of(high, axis);
  if (!from || !to || to->whole < 0 || from->whole >= end) return std::nullopt;
  const auto slice = [&](int64_t place) {
    return std::min(static_cast<uint32_t>(std::max<int64_t>(place, 0)) / size, count - 1);
  };
  const int64_t last = to->part == 0 ? to->whole - 1 : to->whole;
  Slices slices{slice(from->whole), slice(std::min<int64_t>(last, end))};
  slices.last = std::max(slices.last, slices.first);
  if (size % 2 != 0) slices.first -= slices.first % 2;  // coding depends on whether a place is odd
  return slices;
}

struct TileExtent {
  Slices columns, rows;
};

TileExtent tiles_in(const PackFile& pack, const Extent& extent) {
  const TileGrid& grid = pack.grid();
  const Placement& placement = pack.metadata().placement;
  const bool is_degrees = pack.metadata().horizontal_unit == Unit::kDegree;
  const auto rows =
      slices_of(placement.y, extent.south, extent.north, grid.y_max, grid.height, tile_rows(grid));
  for (const Axis& name : names_of_x(placement.x, is_degrees)) {
    const auto columns =
        slices_of(name, extent.west, extent.east, grid.x_max, grid.width, tile_columns(grid));
    if (rows && columns) return {*columns, *rows};
  }
  const CoordinateText x(placement.x), y(placement.y);
  throw Error("has no tile in this extent; it goes from x " + x(0) + ", y " + y(0) + " to x " +
              x(grid.x_max) + ", y " + y(grid.y_max));
}

PackContent cut(const PackFile& pack, const Extent& extent, StreamSpool& streams) {
  const TileExtent kept = tiles_in(pack, extent);
  const TileGrid& grid = pack.grid();
  const uint32_t x = kept.columns.first * grid.width, y = kept.rows.first * grid.height;
  const TileGrid part{std::min(grid.x_max, (kept.columns.last + 1) * grid.width) - x,
                      std::min(grid.y_max, (kept.rows.last + 1) * grid.height) - y, grid.width,
                      grid.height};
  PackContent content{part, metadata_at(pack.metadata(), x, y, part), {}};
  for (uint32_t row = kept.rows.first; row <= kept.rows.last; ++row) {
    for (uint32_t column = kept.columns.first; column <= kept.columns.last; ++column) {
      const uint32_t tile = row * tile_columns(grid) + column;
      TileSummary summary;
      if (std::optional<DecodedTerrain> decoded = pack.tile(tile)) {
        const std::vector<uint8_t> stream = pack.stream(tile);
        summary = summary_of(pack, tile, stream, std::move(*decoded));
        summary.offset = streams.add(stream);
      }
      content.tiles.push_back(summary);
    }
  }
  return content;
}

// A pack that is put together with others, and where it is among them, in places of the first.
struct Part {
  std::string path;
  PackFile file;
  int64_t x = 0, y = 0;
};

bool is_alike(const Metadata& a, const Metadata& b) {
  const auto bound = [](const Metadata& m) {
    return m.accuracy ? m.accuracy->bound : std::optional<Decimal>();
  };
  return a.horizontal_unit == b.horizontal_unit && a.vertical_unit == b.vertical_unit &&
         a.horizontal_epsg == b.horizontal_epsg && a.vertical_epsg == b.vertical_epsg &&
         a.wkt == b.wkt && a.water_level == b.water_level && a.side == b.side &&
         bound(a) == bound(b) && is_same(a.placement.z, b.placement.z);
}

// How many places a pack lies from the first, if its tiles go with the first's.
std::optional<int64_t> shift_of(const Axis& axis, const Axis& first, uint32_t size) {
  const LatticeMap map = map_between(axis, first);
  if (map.step <= 0 || map.scale != map.step || map.shift % map.step != 0) return std::nullopt;
  const Wide shift = map.shift / map.step;
  if (shift % size != 0 || shift % 2 != 0 || magnitude(shift) > INT32_MAX) return std::nullopt;
  return static_cast<int64_t>(shift);
}

Part part_of(const std::string& path, const PackFile* first, const std::string& first_path) {
  Part part{path, std::move(open_pack(path).file)};
  if (first == nullptr) return part;
  const TileGrid &grid = part.file.grid(), &g = first->grid();
  const Metadata &metadata = part.file.metadata(), &m = first->metadata();
  const auto x = shift_of(metadata.placement.x, m.placement.x, g.width);
  const auto y = shift_of(metadata.placement.y, m.placement.y, g.height);
  if (grid.width != g.width || grid.height != g.height || !x || !y || !is_alike(metadata, m)) {
    throw Error(path + ": has other tiles, another lattice, bound or system than " + first_path +
                ": only parts of one plan are joined");
  }
  part.x = *x;
  part.y = *y;
  return part;
}

// Collects the tiles of all parts, by their places.
class Joined {
 public:
  explicit Joined(const std::vector<Part>& parts) : parts_(parts) {
    const TileGrid& tile = parts[0].file.grid();
    int64_t east = 0, north = 0;
    for (const Part& part : parts) {
      x_ = std::min(x_, part.x);
      y_ = std::min(y_, part.y);
      east = std::max(east, part.x + part.file.grid().x_max);
      north = std::max(north, part.y + part.file.grid().y_max);
    }
    grid_ = {static_cast<uint32_t>(east - x_), static_cast<uint32_t>(north - y_), tile.width,
             tile.height};
    if (has_too_many_tiles(grid_))
      throw Error(parts[0].path + " and others: lie too far apart; join packs of one plan");
    for (const Part& part : parts) expect_ends(part);
  }

  PackContent take(StreamSpool& streams) {
    const Metadata& first = parts_[0].file.metadata();
    PackContent content{grid_, metadata_at(first, x_, y_, grid_), {}};
    content.tiles.resize(tile_count(grid_));
    std::vector<const Part*> from(content.tiles.size());
    for (const Part& part : parts_) {
      const uint32_t columns = tile_columns(part.file.grid());
      for (uint32_t tile = 0; tile < part.file.tiles(); ++tile) {
        const uint32_t number = number_of(part, tile % columns, tile / columns);
        if (from[number] == nullptr) {
          from[number] = &part;
          add(part, tile, number, content.tiles[number], streams);
        } else if (part.file.stream(tile) != stream_in(*from[number], number)) {
          throw Error(part.path + ": its tile " + std::to_string(tile) + " is not that of " +
                      from[number]->path);
        }
      }
    }
    return content;
  }

 private:
  // Tiles at a part's end may be narrower, and are so in the whole.
  void expect_ends(const Part& part) const {
    const TileGrid& grid = part.file.grid();
    const bool ends_x = grid.x_max % grid.width == 0 || part.x + grid.x_max == x_ + grid_.x_max;
    const bool ends_y = grid.y_max % grid.height == 0 || part.y + grid.y_max == y_ + grid_.y_max;
    if (ends_x && ends_y) return;
    throw Error(
        part.path +
        ": has narrower tiles at its end than the whole would have there; join packs of one plan");
  }

  uint32_t number_of(const Part& part, uint32_t column, uint32_t row) const {
    const auto columns = static_cast<uint32_t>((part.x - x_) / grid_.width);
    const auto rows = static_cast<uint32_t>((part.y - y_) / grid_.height);
    return (rows + row) * tile_columns(grid_) + columns + column;
  }

  std::vector<uint8_t> stream_in(const Part& part, uint32_t number) const {
    const uint32_t column =
        number % tile_columns(grid_) - static_cast<uint32_t>((part.x - x_) / grid_.width);
    const uint32_t row =
        number / tile_columns(grid_) - static_cast<uint32_t>((part.y - y_) / grid_.height);
    return part.file.stream(row * tile_columns(part.file.grid()) + column);
  }

  void add(const Part& part, uint32_t tile, uint32_t number, TileSummary& summary,
           StreamSpool& streams) {
    std::optional<DecodedTerrain> decoded = part.file.tile(tile);
    if (!decoded) return;
    compare_border(part, number, decoded->mesh());
    const std::vector<uint8_t> stream = part.file.stream(tile);
    summary = summary_of(part.file, tile, stream, std::move(*decoded));
    summary.offset = streams.add(stream);
  }

  // Vertices that the sides of parts have in common have one height.
  void compare_border(const Part& part, uint32_t number, const microtin_mesh* mesh) {
    const TileBox box = tile_box(grid_, number);
    const TileGrid& own = part.file.grid();
    for (uint32_t v = 0; v < microtin_mesh_vertex_count(mesh); ++v) {
      const Vertex vertex = vertex_of(mesh, v);
      const GlobalPost post{box.x + vertex.x, box.y + vertex.y};
      const int64_t x = x_ + post.x - part.x, y = y_ + post.y - part.y;
      if (x != 0 && y != 0 && x != own.x_max && y != own.y_max) continue;
      const auto [found, is_new] = rims_.emplace(post, std::pair(vertex.z, &part));
      if (is_new || found->second.first == vertex.z) continue;
      throw Error(part.path + ": its border is not that of " + found->second.second->path);
    }
  }

  const std::vector<Part>& parts_;
  int64_t x_ = 0, y_ = 0;  // of the whole's first place, from the first part's
  TileGrid grid_{};
  std::map<GlobalPost, std::pair<int16_t, const Part*>> rims_;
};

}  // namespace

PackContent cut_pack(const std::string& path, const Extent& extent, StreamSpool& streams) {
  const OpenPack pack = open_pack(path);
  return with_file_context(path, [&] { return cut(pack.file, extent, streams); });
}

PackContent join_packs(const std::vector<std::string>& paths, StreamSpool& streams) {
  std::vector<Part> parts;
  parts.reserve(paths.size());
  for (const std::string& path : paths) {
    parts.push_back(part_of(path, parts.empty() ? nullptr : &parts[0].file, paths[0]));
  }
  return Joined(parts).take(streams);
}

}  // namespace microtin::product
