// SPDX-License-Identifier: MIT
// The public face of what is read back: real units in, real units out.
#include "microtin/surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/exact/decimal.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/export/post_grid.hpp"
#include "encoder/product/document.hpp"

namespace microtin::encoder {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr int64_t kFraction = 256;  // places have 8 fractional bits

// Somebody's bytes, for readers that know only ours.
class ForeignBytes : public files::ByteSource {
 public:
  explicit ForeignBytes(std::unique_ptr<const Bytes> bytes) : bytes_(std::move(bytes)) {}
  uint64_t size() const override { return bytes_->size(); }
  std::size_t read(uint64_t offset, void* to, std::size_t size) const override {
    return bytes_->read(offset, to, size);
  }

 private:
  std::unique_ptr<const Bytes> bytes_;
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

void take_accuracy(const exact::Metadata& metadata, Facts& facts) {
  if (metadata.true_places) {
    facts.max_error_at_points = to_string(metadata.true_places->max_error);
  }
  if (!metadata.accuracy) return;
  if (metadata.accuracy->bound) facts.bound = to_string(*metadata.accuracy->bound);
  facts.max_error = to_string(metadata.accuracy->max_error);
  facts.rms_error = to_string(metadata.accuracy->rms_error);
  facts.mean_error = to_string(metadata.accuracy->mean_error);
}

Unit unit_of(exact::Unit unit) {
  return static_cast<Unit>(unit);  // the same numbers, those of the note
}

// Heights of z with 16 fractional bits.
double real_height(const microtin_axis& z, int32_t height) {
  return (static_cast<double>(z.offset) * 65536 +
          static_cast<double>(z.numerator) * static_cast<double>(height)) /
         (static_cast<double>(z.denominator) * 65536);
}

// The lattice place of a coordinate, with 8 fractional bits; nothing outside low .. high.
std::optional<int64_t> place_of(const microtin_axis& axis, double value, int64_t low,
                                int64_t high) {
  using Long = long double;
  const Long lattice = (static_cast<Long>(value) * static_cast<Long>(axis.denominator) -
                        static_cast<Long>(axis.offset)) /
                       static_cast<Long>(axis.numerator);
  const Long place = std::floor(lattice * kFraction + Long{0.5});
  if (!(place >= static_cast<Long>(low * kFraction) &&
        place <= static_cast<Long>(high * kFraction))) {
    return std::nullopt;
  }
  return static_cast<int64_t>(place);
}

// The same of `count` posts from `first` on.
std::vector<std::optional<int64_t>> places_of(const microtin_axis& posts, int64_t first,
                                              uint32_t count, const microtin_axis& axis,
                                              int64_t low, int64_t high) {
  if (posts.numerator == 0 || posts.denominator == 0) throw base::Error("an axis has no step");
  const exporting::PostPlaces place(posts, axis, low, high);
  std::vector<std::optional<int64_t>> places(count);
  for (uint32_t i = 0; i < count; ++i) places[i] = place(first + i);
  return places;
}

}  // namespace

struct Surface::Content {
  explicit Content(product::Document read)
      : document(std::move(read)), sampled(document.sampled()), facts(facts_of()) {}

  Facts facts_of() const;
  double height(const std::optional<int64_t>& x, const std::optional<int64_t>& y) const;
  uint32_t tile_at(int64_t x, int64_t y) const;

  product::Document document;
  exporting::SampledSurface sampled;
  Facts facts;
};

Facts Surface::Content::facts_of() const {
  const exact::Metadata metadata = document.metadata();
  Facts all;
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
  all.origin = metadata.source;
  all.date = metadata.date;
  all.lineage = metadata.lineage;
  take_accuracy(metadata, all);
  return all;
}

double Surface::Content::height(const std::optional<int64_t>& x,
                                const std::optional<int64_t>& y) const {
  if (!x || !y) return kNone;
  const std::optional<int32_t> found = sampled.height_at(*x, *y);
  return found ? real_height(facts.z, *found) : kNone;
}

// A tile near the place.
uint32_t Surface::Content::tile_at(int64_t x, int64_t y) const {
  const pack::PackFile* const pack = document.pack();
  if (pack == nullptr) return 0;
  const auto column = static_cast<uint32_t>(x / (pack->grid().width * kFraction));
  const auto row = static_cast<uint32_t>(y / (pack->grid().height * kFraction));
  return row * facts.tile_columns + column;
}

Surface::Surface(std::unique_ptr<Content> content) : content_(std::move(content)) {}
Surface::Surface(Surface&& other) noexcept = default;
Surface& Surface::operator=(Surface&& other) noexcept = default;
Surface::~Surface() = default;

Surface Surface::from_file(const std::string& path) {
  return Surface(std::make_unique<Content>(product::Document(path)));
}

Surface Surface::from_bytes(std::unique_ptr<const Bytes> bytes, const std::string& name) {
  return Surface(std::make_unique<Content>(
      product::Document(name, std::make_unique<ForeignBytes>(std::move(bytes)))));
}

const Facts& Surface::facts() const {
  return content_->facts;
}

Mesh Surface::mesh() const {
  return mesh_of(content_->document.model(), 0, 0);
}

Mesh Surface::tile(uint32_t column, uint32_t row) const {
  const Facts& all = content_->facts;
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
  const Facts& all = content_->facts;
  if (column >= all.tile_columns || row >= all.tile_rows) throw std::out_of_range("no such tile");
  const pack::PackFile* const pack = content_->document.pack();
  if (pack == nullptr) return all.box;
  const TileBox box = microtin::tile_box(pack->grid(), row * all.tile_columns + column);
  return box_of(pack->metadata().placement, box.x, box.y, box.x_end, box.y_end);
}

Grid Surface::grid(const std::string& cell) const {
  const std::optional<exact::Decimal> size = exact::parse_decimal(cell, exact::kPlaceDecimals);
  if (!size || size->mantissa <= 0) throw base::Error("cell: " + cell + " is not a length above 0");
  const exact::PostGrid posts = exporting::grid_of_cells(content_->sampled, *size);
  return {posts.columns, posts.rows, posts.x, posts.y};
}

void Surface::heights(size_t count, const double* x, const double* y, double* heights) const {
  const exporting::SampledSurface& s = content_->sampled;
  struct Query {
    uint32_t tile;
    size_t index;
    int64_t x, y;
  };
  std::vector<Query> queries;
  for (size_t i = 0; i < count; ++i) {
    heights[i] = kNone;
    const auto px = place_of(s.placement.x, x[i], s.x_min, s.x_max);
    const auto py = place_of(s.placement.y, y[i], s.y_min, s.y_max);
    if (px && py) queries.push_back({content_->tile_at(*px, *py), i, *px, *py});
  }
  // So that each tile is decoded once.
  std::stable_sort(queries.begin(), queries.end(),
                   [](const Query& a, const Query& b) { return a.tile < b.tile; });
  for (const Query& query : queries) heights[query.index] = content_->height(query.x, query.y);
}

void Surface::heights(const Grid& grid, const Rectangle& rectangle, double* heights) const {
  const exporting::SampledSurface& s = content_->sampled;
  const auto xs =
      places_of(grid.x, rectangle.column, rectangle.columns, s.placement.x, s.x_min, s.x_max);
  const auto ys = places_of(grid.y, rectangle.row, rectangle.rows, s.placement.y, s.y_min, s.y_max);
  for (auto y = ys.rbegin(); y != ys.rend(); ++y) {
    for (const std::optional<int64_t>& x : xs) *heights++ = content_->height(x, *y);
  }
}

}  // namespace microtin::encoder
