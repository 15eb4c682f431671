// SPDX-License-Identifier: MIT
// The public face of what is read back: real units in, real units out.
#include "microtin/surface.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/exact/decimal.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/exact/units.hpp"
#include "encoder/export/grid.hpp"
#include "encoder/export/queries.hpp"
#include "encoder/export/scene.hpp"
#include "encoder/product/document.hpp"
#include "encoder/stream/header.hpp"
#include "encoder/terrain/exact_query.hpp"
#include "encoder/terrain/line_class.hpp"
#include "encoder/verify/everywhere.hpp"

namespace microtin::encoder {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Somebody's bytes, for readers that know only ours.
class ForeignBytes : public files::ByteSource {
 public:
  explicit ForeignBytes(std::unique_ptr<const encoder::ByteSource> bytes)
      : bytes_(std::move(bytes)) {}
  uint64_t size() const override { return bytes_->size(); }
  std::size_t read(uint64_t offset, void* to, std::size_t size) const override {
    return bytes_->read(offset, to, size);
  }

 private:
  std::unique_ptr<const encoder::ByteSource> bytes_;
};

Box box_of(const exact::Placement& placement, int64_t west, int64_t south, int64_t east,
           int64_t north) {
  return {coordinate(placement.x, west), coordinate(placement.y, south),
          coordinate(placement.x, east), coordinate(placement.y, north)};
}

Mesh mesh_of(const stream::SurfaceModel& model, int64_t x, int64_t y) {
  const exact::Placement& p = model.placement;
  Mesh mesh;
  mesh.vertices.reserve(model.vertices.size());
  for (const auto& [vx, vy, vz] : model.vertices) {
    mesh.vertices.push_back(
        {coordinate(p.x, x + vx), coordinate(p.y, y + vy), coordinate(p.z, vz)});
  }
  mesh.triangles = model.triangles;
  return mesh;
}

void take_accuracy(const terrain::Metadata& metadata, SurfaceInfo& info) {
  if (metadata.true_places) {
    info.max_error_at_points = to_string(metadata.true_places->max_error);
  }
  if (metadata.at_samples) {
    info.max_below = to_string(metadata.at_samples->below);
    info.max_above = to_string(metadata.at_samples->above);
  }
  const auto everywhere = verifying::stated_everywhere(metadata.everywhere, metadata.placement.z);
  if (everywhere) {
    info.max_below_everywhere = to_string(everywhere->below);
    info.max_above_everywhere = to_string(everywhere->above);
  }
  if (metadata.bounds) {
    info.least_bound = to_string(metadata.bounds->span.least);
    info.largest_bound = to_string(metadata.bounds->span.largest);
    info.max_bound_ratio = to_string(metadata.bounds->span.ratio);
  }
  if (!metadata.accuracy) return;
  if (metadata.accuracy->bound) info.bound = to_string(*metadata.accuracy->bound);
  info.max_error = to_string(metadata.accuracy->max_error);
  info.rms_error = to_string(metadata.accuracy->rms_error);
  info.mean_error = to_string(metadata.accuracy->mean_error);
}

void take_measured_notes(const std::vector<uint8_t>& bytes, SurfaceInfo& info) {
  const stream::Header header = stream::read_header(bytes);
  if (header.metadata.digest) info.digest = base::hexadecimal(*header.metadata.digest);
  for (const terrain::PhaseEnd& end : header.metadata.phases) {
    info.phases.push_back({end.vertices, header.info.header_bytes + end.bytes,
                           end.max_error ? to_string(*end.max_error) : std::string()});
  }
}

Unit unit_of(exact::Unit unit) {
  return static_cast<Unit>(unit);  // the same numbers, those of the note
}

using Coordinates = std::vector<std::optional<exact::RealCoordinate>>;

// The places of `count` posts from `first` on; nothing outside the surface.
Coordinates places_of(const exporting::PostPlaces& place, int64_t first, uint32_t count) {
  Coordinates places(count);
  for (uint32_t i = 0; i < count; ++i) places[i] = place(first + i);
  return places;
}

void expect_step(const microtin_axis& posts) {
  if (posts.numerator == 0 || posts.denominator == 0) throw base::Error("an axis has no step");
}

// x on a surface, by the first name of a place that lies on it.
class BinaryNames {
 public:
  explicit BinaryNames(const exporting::SampledSurface& s) {
    for (const exact::Axis& name : exact::names_of_x(s.placement.x, s.is_degrees)) {
      names_.emplace_back(name, s.x_min, s.x_max);
    }
  }
  std::optional<exact::RealCoordinate> operator()(double value) const {
    for (const exact::BinaryAxis& name : names_) {
      if (const auto at = name(value)) return at;
    }
    return std::nullopt;
  }

 private:
  std::vector<exact::BinaryAxis> names_;
};

}  // namespace

struct Surface::Content {
  explicit Content(product::Document read)
      : document(std::move(read)), sampled(document.sampled()), info(info_of()) {}

  SurfaceInfo info_of() const;
  template <class Visit>
  void for_places(size_t count, const double* x, const double* y, const Visit& visit) const;
  double height(const exact::RealPlace& place) const;
  uint32_t tile_at(int64_t x, int64_t y) const;
  exporting::TileHeights heights_of(uint32_t tile) const;
  HeightBounds bounds_of(const exporting::AreaHeights& found) const;

  product::Document document;
  exporting::SampledSurface sampled;
  SurfaceInfo info;
};

SurfaceInfo Surface::Content::info_of() const {
  const terrain::Metadata metadata = document.metadata();
  SurfaceInfo all;
  all.bytes = document.bytes();
  all.vertices = document.vertices();
  all.box = box_of(sampled.placement, sampled.x_min, sampled.y_min, sampled.x_max, sampled.y_max);
  all.lowest = coordinate(sampled.placement.z, sampled.lowest);
  all.highest = coordinate(sampled.placement.z, sampled.highest);
  all.x = sampled.placement.x;
  all.y = sampled.placement.y;
  all.z = sampled.placement.z;
  if (const pack::PackFile* const pack = document.pack()) {
    all.is_pack = true;
    all.tile_columns = tile_columns(pack->grid());
    all.tile_rows = tile_rows(pack->grid());
  }
  if (metadata.grid) {
    all.source = {metadata.grid->columns, metadata.grid->rows, metadata.grid->x, metadata.grid->y};
  }
  all.horizontal_unit = unit_of(metadata.horizontal_unit);
  all.vertical_unit = unit_of(metadata.vertical_unit);
  all.horizontal_epsg = metadata.horizontal_epsg;
  all.vertical_epsg = metadata.vertical_epsg;
  all.wkt = metadata.wkt;
  all.source_name = metadata.source;
  all.date = metadata.date;
  all.lineage = metadata.lineage;
  all.attribution = metadata.attribution;
  all.license = metadata.license;
  all.valid = metadata.valid;
  if (metadata.epoch) all.epoch = to_string(*metadata.epoch);
  if (metadata.source_accuracy) all.source_accuracy = to_string(*metadata.source_accuracy);
  all.surface = static_cast<SurfaceKind>(metadata.surface);  // the same numbers, those of the note
  all.side = static_cast<BoundSide>(metadata.side);
  take_accuracy(metadata, all);
  if (document.stream() != nullptr) take_measured_notes(document.stream()->bytes, all);
  return all;
}

double Surface::Content::height(const exact::RealPlace& place) const {
  const terrain::ExactAnswer found = sampled.height_at(place);
  return found.kind == MICROTIN_QUERY_OK ? exact::real_height(info.z, found.height) : kNone;
}

// Calls visit(i, place) for the positions that the surface may have. Those of a tile come one after
// another, so that each tile is decoded once.
template <class Visit>
void Surface::Content::for_places(size_t count, const double* x, const double* y,
                                  const Visit& visit) const {
  struct Query {
    uint32_t tile;
    size_t index;
    exact::RealPlace place;
  };
  const BinaryNames on_x(sampled);
  const exact::BinaryAxis on_y(sampled.placement.y, sampled.y_min, sampled.y_max);
  std::vector<Query> queries;
  for (size_t i = 0; i < count; ++i) {
    const auto px = on_x(x[i]), py = on_y(y[i]);
    if (!px || !py) continue;
    const exact::RealPlace place = exact::place_of(*px, *py);
    if (document.pack() == nullptr) {
      visit(i, place);
    } else {
      queries.push_back({tile_at(place.x, place.y), i, place});
    }
  }
  std::stable_sort(queries.begin(), queries.end(),
                   [](const Query& a, const Query& b) { return a.tile < b.tile; });
  for (const Query& query : queries) visit(query.index, query.place);
}

// A tile near the place.
uint32_t Surface::Content::tile_at(int64_t x, int64_t y) const {
  const pack::PackFile* const pack = document.pack();
  if (pack == nullptr) return 0;
  const auto column = static_cast<uint32_t>(x / pack->grid().width);
  const auto row = static_cast<uint32_t>(y / pack->grid().height);
  return row * info.tile_columns + column;
}

exporting::TileHeights Surface::Content::heights_of(uint32_t tile) const {
  const pack::PackFile* const pack = document.pack();
  if (pack == nullptr) return {true, sampled.lowest, sampled.highest};
  const pack::IndexEntry& entry = pack->entries()[tile];
  return {entry.size != 0, entry.lowest, entry.highest};
}

HeightBounds Surface::Content::bounds_of(const exporting::AreaHeights& found) const {
  HeightBounds bounds;
  bounds.is_complete = found.is_complete && found.has_terrain;
  if (!found.has_terrain) return bounds;
  bounds.lowest = coordinate(info.z, found.lowest);
  bounds.highest = coordinate(info.z, found.highest);
  const auto below = exact::parse_decimal(info.max_below_everywhere),
             above = exact::parse_decimal(info.max_above_everywhere);
  if (!below || !above) return bounds;
  bounds.source_lowest = bounds.lowest - exact::real(*above);
  bounds.source_highest = bounds.highest + exact::real(*below);
  return bounds;
}

Surface::Surface(std::unique_ptr<Content> content) : content_(std::move(content)) {}
Surface::Surface(Surface&& other) noexcept = default;
Surface& Surface::operator=(Surface&& other) noexcept = default;
Surface::~Surface() = default;

Surface Surface::from_file(const std::string& path) {
  return Surface(std::make_unique<Content>(product::Document(path)));
}

Surface Surface::from_bytes(std::unique_ptr<const ByteSource> bytes, const std::string& name) {
  return Surface(std::make_unique<Content>(
      product::Document(name, std::make_unique<ForeignBytes>(std::move(bytes)))));
}

const SurfaceInfo& Surface::info() const {
  return content_->info;
}

Mesh Surface::mesh() const {
  return mesh_of(content_->document.model(), 0, 0);
}

std::vector<Line> Surface::lines() const {
  const product::DecodedStream* const stream = content_->document.stream();
  if (stream == nullptr) return {};
  const exact::Placement p = content_->document.metadata().placement;
  std::vector<Line> lines;
  for (const terrain::MarkedLine& marked : stream->terrain.lines()) {
    Line line{std::string(name_of(marked.kind)), {}};
    for (const uint32_t v : marked.vertices) {
      const auto vertex = terrain::vertex_of(stream->terrain.mesh(), v);
      line.vertices.push_back(
          {coordinate(p.x, vertex.x), coordinate(p.y, vertex.y), coordinate(p.z, vertex.z)});
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

Mesh Surface::tile(uint32_t column, uint32_t row) const {
  const SurfaceInfo& all = content_->info;
  if (column >= all.tile_columns || row >= all.tile_rows) throw std::out_of_range("no such tile");
  const pack::PackFile* const pack = content_->document.pack();
  if (pack == nullptr) return mesh();
  const uint32_t number = row * all.tile_columns + column;
  const std::optional<stream::DecodedTerrain> terrain = content_->document.tile(number);
  if (!terrain) return {};
  stream::SurfaceModel model = stream::model_of(terrain->mesh());
  model.placement = pack->metadata().placement;
  const TileBox box = microtin::tile_box(pack->grid(), number);
  return mesh_of(model, box.x, box.y);
}

Box Surface::tile_box(uint32_t column, uint32_t row) const {
  const SurfaceInfo& all = content_->info;
  if (column >= all.tile_columns || row >= all.tile_rows) throw std::out_of_range("no such tile");
  const pack::PackFile* const pack = content_->document.pack();
  if (pack == nullptr) return all.box;
  const TileBox box = microtin::tile_box(pack->grid(), row * all.tile_columns + column);
  return box_of(pack->metadata().placement, box.x, box.y, box.x_end, box.y_end);
}

TileMargins Surface::tile_margins(uint32_t column, uint32_t row) const {
  const SurfaceInfo& all = content_->info;
  if (column >= all.tile_columns || row >= all.tile_rows) throw std::out_of_range("no such tile");
  const pack::PackFile* const pack = content_->document.pack();
  if (pack == nullptr) return {all.max_below_everywhere, all.max_above_everywhere};
  const terrain::Margins margins = base::with_file_context(
      content_->document.path(), [&] { return pack->margins(row * all.tile_columns + column); });
  const auto stated = verifying::stated_everywhere(margins, pack->metadata().placement.z);
  if (!stated) return {};
  return {to_string(stated->below), to_string(stated->above)};
}

Grid Surface::grid(const std::string& cell) const {
  if (cell.empty()) {
    if (info().source.columns == 0)
      throw base::Error("a surface of points has no grid of its own: give the size of a cell");
    return info().source;
  }
  const std::optional<exact::Decimal> size = exact::parse_decimal(cell, exact::kPlaceDecimals);
  if (!size || size->mantissa <= 0) throw base::Error("cell: " + cell + " is not a length above 0");
  const terrain::PostGrid posts = exporting::grid_of_cells(content_->sampled, *size);
  return {posts.columns, posts.rows, posts.x, posts.y};
}

void Surface::heights(size_t count, const double* x, const double* y, double* heights) const {
  std::fill(heights, heights + count, kNone);
  content_->for_places(count, x, y, [&](size_t i, const exact::RealPlace& place) {
    heights[i] = content_->height(place);
  });
}

void Surface::gradients(size_t count, const double* x, const double* y, double* east,
                        double* north) const {
  const SurfaceInfo& all = content_->info;
  const auto metres = [](Unit unit) {
    return exact::metres_per(static_cast<exact::Unit>(unit)).value_or(1);
  };
  const double rise = exact::step_of(all.z) * metres(all.vertical_unit);
  std::fill(east, east + count, kNone);
  std::fill(north, north + count, kNone);
  exporting::GradientSearch search;
  content_->for_places(count, x, y, [&](size_t i, const exact::RealPlace& place) {
    const auto found = exporting::gradient_at(content_->sampled, place, search);
    if (!found) return;
    exporting::Degree unit = {1, 1};
    if (all.horizontal_unit == Unit::kDegree) {
      unit = exporting::degree_at(y[i]);
    } else {
      unit.x = unit.y = metres(all.horizontal_unit);
    }
    east[i] = found->x * rise / (exact::step_of(all.x) * unit.x);
    north[i] = found->y * rise / (exact::step_of(all.y) * unit.y);
  });
}

HeightBounds Surface::bounds_in_box(const Box& box) const {
  return content_->bounds_of(exporting::heights_in_box(
      content_->sampled, [this](uint32_t tile) { return content_->heights_of(tile); },
      {box.west, box.south}, {box.east, box.north}));
}

HeightBounds Surface::bounds_on_line(const Position& from, const Position& to) const {
  return content_->bounds_of(exporting::heights_on_line(
      content_->sampled, [this](uint32_t tile) { return content_->heights_of(tile); },
      {from.x, from.y}, {to.x, to.y}));
}

Profile Surface::profile(const Position& from, const Position& to) const {
  const SurfaceInfo& all = content_->info;
  const auto unit = [](Unit known) { return static_cast<exact::Unit>(known); };
  return base::with_file_context(content_->document.path(), [&] {
    return exporting::profile_of(content_->sampled, unit(all.horizontal_unit),
                                 unit(all.vertical_unit), {from.x, from.y}, {to.x, to.y});
  });
}

void Surface::heights(const Grid& grid, const Rectangle& rectangle, double* heights) const {
  const exporting::SampledSurface& s = content_->sampled;
  expect_step(grid.x);
  expect_step(grid.y);
  const Coordinates xs =
      places_of(exporting::places_of_x(s, grid.x), rectangle.column, rectangle.columns);
  const Coordinates ys =
      places_of(exporting::places_of_y(s, grid.y), rectangle.row, rectangle.rows);
  for (auto y = ys.rbegin(); y != ys.rend(); ++y) {
    for (const auto& x : xs) {
      *heights++ = x && *y ? content_->height(exact::place_of(*x, **y)) : kNone;
    }
  }
}

}  // namespace microtin::encoder
