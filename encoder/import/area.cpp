// SPDX-License-Identifier: MIT
// Marks what polygons hold, and drops the rest.
#include "encoder/import/area.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/import/corridor.hpp"

namespace microtin::importing {

void Area::add_polygons(const std::string& path, const FeatureFiles& files) {
  const std::size_t before = polygons_.size();
  for (Feature& feature : files.read(path)) {
    std::move(feature.polygons.begin(), feature.polygons.end(), std::back_inserter(polygons_));
  }
  if (polygons_.size() == before) throw Error(path + ": has no polygon; draw one around the area");
}

void Area::add_corridors(const std::string& path, const FeatureFiles& files, Decimal width,
                         Unit unit) {
  std::vector<RealRings> corridors =
      corridors_of(path, files.read(path), exact::real(width) / 2, unit);
  if (corridors.empty()) throw Error(path + ": has no line; draw the route as one");
  std::move(corridors.begin(), corridors.end(), std::back_inserter(polygons_));
}

void Area::cut(Raster& raster) const {
  std::vector<bool> is_inside(raster.heights.size());
  for (const RealRings& polygon : polygons_) {
    const terrain::Rings rings(polygon, raster.x, raster.y);
    rings.visit_inside(raster.width, raster.height, [&](uint32_t column, uint32_t row) {
      is_inside[std::size_t{row} * raster.width + column] = true;
    });
  }
  for (std::size_t i = 0; i < is_inside.size(); ++i) {
    if (!is_inside[i] && terrain::is_height(raster.heights[i])) {
      raster.heights[i] = terrain::kVoidHeight;
    }
  }
}

void Area::cut(PointCloud& cloud) const {
  const Axis axis = decimal_axis(cloud.xy_decimals);
  std::vector<terrain::Rings> all;
  all.reserve(polygons_.size());
  for (const RealRings& polygon : polygons_) all.emplace_back(polygon, axis, axis);
  const auto is_outside = [&](const terrain::SourcePoint& p) {
    return std::none_of(all.begin(), all.end(),
                        [&](const terrain::Rings& rings) { return rings.contains(p.x, p.y); });
  };
  cloud.points.erase(std::remove_if(cloud.points.begin(), cloud.points.end(), is_outside),
                     cloud.points.end());
}

namespace {

class CutRaster : public RasterReader {
 public:
  CutRaster(std::unique_ptr<RasterReader> raster, Area area)
      : raster_(std::move(raster)), area_(std::move(area)) {
    frame_ = raster_->frame();
  }

  Raster read(const terrain::PostRectangle& rectangle) const override {
    Raster part = raster_->read(rectangle);
    area_.cut(part);
    return part;
  }

  std::vector<bool> absent_in(const terrain::PostRectangle& rectangle) const override {
    return raster_->absent_in(rectangle);
  }

 private:
  std::unique_ptr<RasterReader> raster_;
  Area area_;
};

}  // namespace

std::unique_ptr<RasterReader> within_area(std::unique_ptr<RasterReader> raster, Area area) {
  return std::make_unique<CutRaster>(std::move(raster), std::move(area));
}

}  // namespace microtin::importing
