// SPDX-License-Identifier: MIT
// Keeps the part of a terrain that lies in polygons or near a route.
#ifndef MICROTIN_ENCODER_IMPORT_AREA_HPP
#define MICROTIN_ENCODER_IMPORT_AREA_HPP

#include <memory>
#include <string>
#include <vector>

#include "encoder/exact/decimal.hpp"
#include "encoder/exact/units.hpp"
#include "encoder/import/features.hpp"
#include "encoder/import/import.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/polygons.hpp"

namespace microtin::importing {

// Polygons in the terrain's own system; borders belong to them.
class Area {
 public:
  // Adds those of a file. Throws Error naming the file, also if it has none.
  void add_polygons(const std::string& path, const FeatureFiles& files);

  // Adds what lies within half of `width` metres of the lines of a file (corridor.hpp). Throws
  // Error naming the file, also if it has none.
  void add_corridors(const std::string& path, const FeatureFiles& files, Decimal width, Unit unit);

  // Makes the posts outside void, or leaves the points outside out.
  void cut(Raster& raster) const;
  void cut(PointCloud& cloud) const;

 private:
  std::vector<RealRings> polygons_;
};

// A raster whose posts outside the area are void when it is read.
std::unique_ptr<RasterReader> within_area(std::unique_ptr<RasterReader> raster, Area area);

}  // namespace microtin::importing

#endif
