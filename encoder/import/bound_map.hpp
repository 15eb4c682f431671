// SPDX-License-Identifier: MIT
// Bounds for the posts or points of a terrain, out of a raster of bounds or polygons with a bound.
#ifndef MICROTIN_ENCODER_IMPORT_BOUND_MAP_HPP
#define MICROTIN_ENCODER_IMPORT_BOUND_MAP_HPP

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "encoder/import/features.hpp"
#include "encoder/import/import.hpp"
#include "encoder/layers.hpp"

namespace microtin::importing {

// A map of bounds in the unit of the terrain's heights; its places are in the terrain's system.
class BoundMap {
 public:
  // Reads polygons from a file of features, or opens a raster: both outside of which `max_error` is
  // the bound. Throws Error naming the file.
  BoundMap(const std::string& path, const FeatureFiles& files,
           const std::optional<Decimal>& max_error);

  // Takes a raster of bounds. `name` goes into messages.
  BoundMap(const std::string& name, std::unique_ptr<RasterReader> bounds,
           const std::optional<Decimal>& max_error);

  // Takes polygons with a bound each, outside of which `max_error` is the bound.
  BoundMap(const std::string& name, std::vector<Feature> polygons, const Decimal& max_error);

  // Adds polygons with a bound each.
  void add(std::vector<Feature> polygons);

  // Throws Error naming the map if it is a raster in another system than the terrain.
  void expect_system(const Reference& terrain) const;

  // Cells along an axis: first > last where there are none.
  struct Touched {
    int64_t first, last;
  };

  // What the bounds of all terrains have in common.
  const OwnBounds& frame() const { return frame_; }

  // Gives each post or point its bound: the least of the cells and polygons that it touches. Posts
  // in none of them take max_error, and posts that touch only void cells, or polygons of null, have
  // no bound. Throws Error naming the map.
  void bound(Raster& raster) const;
  void bound(PointCloud& cloud) const;

 private:
  void read_polygons(const std::string& path, const FeatureFiles& files);
  void take_scale();
  int64_t number_of(Decimal bound) const;
  void add_polygons(const Raster& raster, std::vector<int64_t>& numbers) const;
  void add_cells(const Raster& raster, std::vector<int64_t>& numbers) const;
  int64_t least_of(const Raster& cells, Touched columns, Touched rows) const;
  void finish(std::vector<int64_t>& numbers) const;

  std::string name_;
  std::optional<Decimal> max_error_;
  std::vector<Feature> polygons_;
  std::unique_ptr<RasterReader> cells_;  // null: polygons
  OwnBounds frame_;
};

// A raster whose posts get their bounds when it is read.
std::unique_ptr<RasterReader> with_bounds(std::unique_ptr<RasterReader> raster,
                                          std::shared_ptr<const BoundMap> map);

}  // namespace microtin::importing

#endif
