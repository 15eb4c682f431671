// SPDX-License-Identifier: MIT
// Finds which cells and polygons each post touches.
#include "encoder/import/bound_map.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/import/reference.hpp"

namespace microtin::importing {
namespace {

using terrain::kUnbounded;

constexpr int64_t kOutside = -1;       // of the map: no number of a bound
constexpr uint32_t kRowsAtOnce = 256;  // of a map that is looked through

// The lesser of two bounds; kUnbounded is above all, and kOutside above that.
int64_t lesser(int64_t a, int64_t b) {
  if (a == kOutside || b == kOutside) return a == kOutside ? b : a;
  if (a == kUnbounded || b == kUnbounded) return a == kUnbounded ? b : a;
  return std::min(a, b);
}

using Touched = BoundMap::Touched;

Touched touched(const LatticeMap& map, Wide number, uint32_t cells) {
  const Wide twice = 2 * map.numerator(number), step = 2 * map.step;  // in cells, from centres
  const Wide first = ceil_divide(twice - map.step, step),
             last = floor_divide(twice + map.step, step);
  return {static_cast<int64_t>(std::clamp<Wide>(first, 0, cells)),
          static_cast<int64_t>(std::clamp<Wide>(last, -1, Wide{cells} - 1))};
}

std::vector<Touched> all_touched(const Axis& posts, uint32_t count, const Axis& cells,
                                 uint32_t cell_count) {
  const LatticeMap map = map_between(posts, cells);
  std::vector<Touched> all;
  all.reserve(count);
  for (uint32_t i = 0; i < count; ++i) all.push_back(touched(map, i, cell_count));
  return all;
}

// The cells from the first to the last that any of the posts touches; none: first > last.
Touched hull_of(const std::vector<Touched>& all) {
  Touched hull{std::numeric_limits<int64_t>::max(), -1};
  for (const Touched& one : all) {
    if (one.first > one.last) continue;
    hull = {std::min(hull.first, one.first), std::max(hull.last, one.last)};
  }
  return hull;
}

}  // namespace

BoundMap::BoundMap(const std::string& path, const FeatureFiles& files,
                   const std::optional<Decimal>& max_error)
    : name_(path), max_error_(max_error) {
  if (files.has_features(path)) {
    read_polygons(path, files);
  } else {
    OpenSource source = open_terrain(path);
    auto* const raster = std::get_if<std::unique_ptr<RasterReader>>(&source);
    if (raster == nullptr) throw Error(path + ": is not a raster of bounds; use one, or GeoJSON");
    cells_ = std::move(*raster);
  }
  take_scale();
}

BoundMap::BoundMap(const std::string& name, std::unique_ptr<RasterReader> bounds,
                   const std::optional<Decimal>& max_error)
    : name_(name), max_error_(max_error), cells_(std::move(bounds)) {
  take_scale();
}

BoundMap::BoundMap(const std::string& name, std::vector<Feature> polygons, const Decimal& max_error)
    : name_(name), max_error_(max_error), polygons_(std::move(polygons)) {
  take_scale();
}

void BoundMap::expect_system(const Reference& terrain) const {
  if (cells_ == nullptr) return;
  with_file_context(name_,
                    [&] { expect_same_horizontal_system(cells_->frame().reference, terrain); });
}

void BoundMap::add(std::vector<Feature> polygons) {
  std::move(polygons.begin(), polygons.end(), std::back_inserter(polygons_));
  take_scale();
}

void BoundMap::read_polygons(const std::string& path, const FeatureFiles& files) {
  for (Feature& feature : files.read(path)) {
    if (feature.has_max_error && feature.polygons.empty()) {
      throw Error(path + ": a property max_error is for polygons, and this is a line or a point");
    }
    if (feature.polygons.empty()) continue;
    if (!feature.has_max_error) throw Error(path + ": a polygon has no property max_error");
    polygons_.push_back(std::move(feature));
  }
  if (polygons_.empty())
    throw Error(path + ": has no polygon; give each bound one, or name a raster of bounds");
}

// The decimals that all bounds need, and the max_error at which they hold: the one that is given,
// or the largest of the map.
void BoundMap::take_scale() {
  Decimal largest;
  const auto see = [&](Decimal bound) {
    if (largest <= bound) largest = bound;
  };
  if (max_error_) frame_.decimals = max_error_->decimals;
  for (const Feature& feature : polygons_) {
    if (!feature.max_error) continue;
    see(*feature.max_error);
    frame_.decimals = std::max(frame_.decimals, feature.max_error->decimals);
  }
  if (cells_)
    frame_.decimals = std::max(frame_.decimals, std::min(cells_->frame().decimals, kMaxDecimals));
  if (cells_ && !max_error_) {
    const Raster& frame = cells_->frame();
    for (uint32_t row = 0; row < frame.height; row += kRowsAtOnce) {
      const Raster part =
          cells_->read({0, row, frame.width, std::min(kRowsAtOnce, frame.height - row)});
      for (const int64_t cell : part.heights) {
        if (terrain::is_height(cell)) see(make_decimal(cell, part.decimals));
      }
    }
  }
  frame_.unscaled = max_error_ ? *max_error_ : largest;
}

// Rounded down.
int64_t BoundMap::number_of(Decimal bound) const {
  const Wide number = floor_divide(Wide{bound.mantissa} * power_of_ten(frame_.decimals),
                                   power_of_ten(bound.decimals));
  return static_cast<int64_t>(std::min<Wide>(number, terrain::kLargestNumber));
}

void BoundMap::add_polygons(const Raster& raster, std::vector<int64_t>& numbers) const {
  for (const Feature& feature : polygons_) {
    const int64_t bound = feature.max_error ? number_of(*feature.max_error) : kUnbounded;
    for (const RealRings& polygon : feature.polygons) {
      const terrain::Rings rings(polygon, raster.x, raster.y);
      rings.visit_inside(raster.width, raster.height, [&](uint32_t column, uint32_t row) {
        int64_t& number = numbers[std::size_t{row} * raster.width + column];
        number = lesser(number, bound);
      });
    }
  }
}

void BoundMap::add_cells(const Raster& raster, std::vector<int64_t>& numbers) const {
  const Raster& frame = cells_->frame();
  const auto columns = all_touched(raster.x, raster.width, frame.x, frame.width);
  const auto rows = all_touched(raster.y, raster.height, frame.y, frame.height);
  const Touched x = hull_of(columns), y = hull_of(rows);
  if (x.first > x.last || y.first > y.last) return;
  const Raster cells = cells_->read({static_cast<uint32_t>(x.first), static_cast<uint32_t>(y.first),
                                     static_cast<uint32_t>(x.last - x.first + 1),
                                     static_cast<uint32_t>(y.last - y.first + 1)});
  const auto from = [](Touched some, int64_t first) {
    return Touched{some.first - first, some.last - first};
  };
  std::size_t post = 0;
  for (const Touched& row : rows) {
    for (const Touched& column : columns) {
      int64_t& number = numbers[post++];
      number = lesser(number, least_of(cells, from(column, x.first), from(row, y.first)));
    }
  }
}

// The least bound of cells.
int64_t BoundMap::least_of(const Raster& cells, Touched columns, Touched rows) const {
  int64_t least = kOutside;
  for (int64_t row = rows.first; row <= rows.last; ++row) {
    for (int64_t column = columns.first; column <= columns.last; ++column) {
      const int64_t cell = cells.heights[static_cast<std::size_t>(row * cells.width + column)];
      if (cell == terrain::kNoPost) continue;
      if (terrain::is_height(cell) && cell < 0) {
        throw Error(name_ + ": the bound " + to_string(make_decimal(cell, cells.decimals)) +
                    " is below 0; mark posts without a bound as void");
      }
      const bool is_void = cell == terrain::kVoidHeight;
      least = lesser(least, is_void ? kUnbounded : number_of(make_decimal(cell, cells.decimals)));
    }
  }
  return least;
}

void BoundMap::finish(std::vector<int64_t>& numbers) const {
  for (int64_t& number : numbers) {
    if (number != kOutside) continue;
    if (!max_error_) {
      throw Error(name_ + ": does not cover the terrain; set the bound elsewhere with " +
                  parameter("max_error"));
    }
    number = number_of(*max_error_);
  }
}

void BoundMap::bound(Raster& raster) const {
  std::vector<int64_t> numbers(raster.heights.size(), kOutside);
  if (cells_) add_cells(raster, numbers);
  add_polygons(raster, numbers);
  finish(numbers);
  raster.bounds = frame_;
  raster.bounds.numbers = std::move(numbers);
}

// Each point is a raster of one post.
void BoundMap::bound(PointCloud& cloud) const {
  std::vector<int64_t> numbers(cloud.points.size(), kOutside);
  const Axis axis = decimal_axis(cloud.xy_decimals);
  for (const Feature& feature : polygons_) {
    const int64_t bound = feature.max_error ? number_of(*feature.max_error) : kUnbounded;
    for (const RealRings& polygon : feature.polygons) {
      const terrain::Rings rings(polygon, axis, axis);
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (rings.contains(cloud.points[i].x, cloud.points[i].y))
          numbers[i] = lesser(numbers[i], bound);
      }
    }
  }
  if (cells_) {
    const Raster& frame = cells_->frame();
    const Raster cells = cells_->read({0, 0, frame.width, frame.height});
    const LatticeMap x = map_between(axis, frame.x), y = map_between(axis, frame.y);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const Touched columns = touched(x, cloud.points[i].x, frame.width);
      const Touched rows = touched(y, cloud.points[i].y, frame.height);
      numbers[i] = lesser(numbers[i], least_of(cells, columns, rows));
    }
  }
  finish(numbers);
  cloud.bounds = frame_;
  cloud.bounds.numbers = std::move(numbers);
}

namespace {

class BoundedRaster : public RasterReader {
 public:
  BoundedRaster(std::unique_ptr<RasterReader> raster, std::shared_ptr<const BoundMap> map)
      : raster_(std::move(raster)), map_(std::move(map)) {
    frame_ = raster_->frame();
    frame_.bounds = map_->frame();
  }

  Raster read(const PostRectangle& rectangle) const override {
    Raster part = raster_->read(rectangle);
    map_->bound(part);
    return part;
  }

  std::vector<bool> absent_in(const PostRectangle& rectangle) const override {
    return raster_->absent_in(rectangle);
  }

 private:
  std::unique_ptr<RasterReader> raster_;
  std::shared_ptr<const BoundMap> map_;
};

}  // namespace

std::unique_ptr<RasterReader> with_bounds(std::unique_ptr<RasterReader> raster,
                                          std::shared_ptr<const BoundMap> map) {
  return std::make_unique<BoundedRaster>(std::move(raster), std::move(map));
}

}  // namespace microtin::importing
