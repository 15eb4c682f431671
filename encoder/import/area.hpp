// SPDX-License-Identifier: MIT
// The part of a terrain that lies in polygons.
#ifndef MICROTIN_ENCODER_IMPORT_AREA_HPP
#define MICROTIN_ENCODER_IMPORT_AREA_HPP

#include <memory>
#include <string>
#include <vector>

#include "encoder/import/import.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/polygons.hpp"

namespace microtin::importing {

// Polygons of a GeoJSON file, in the terrain's own system; borders belong to them.
class Area {
 public:
  // Throws Error naming the file, also if it has no polygon.
  explicit Area(const std::string& path);

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
