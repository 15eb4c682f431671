// SPDX-License-Identifier: MIT
// Towers, power lines and cranes over a terrain.
#ifndef MICROTIN_ENCODER_IMPORT_OBSTACLES_HPP
#define MICROTIN_ENCODER_IMPORT_OBSTACLES_HPP

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "encoder/exact/decimal.hpp"
#include "encoder/import/geojson.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::importing {

class Obstacles {
 public:
  // Reads a GeoJSON file: points, lines and polygons with a `top` above the zero of the terrain's
  // heights, or a `height` above the ground, and a `radius` in metres. Throws Error naming it.
  explicit Obstacles(const std::string& path);

  // Raises all posts of each cell that an obstacle touches to its top at least; void posts stay
  // void. `max_error` is the bound of posts that have none of their own. Posts near raised ones get
  // wider bounds. Throws Error naming the file. O(obstacles x posts that they touch), but at least
  // O(obstacles x rows).
  void raise(terrain::Raster& raster, const std::optional<Decimal>& max_error) const;

 private:
  std::string path_;
  std::vector<Feature> features_;
};

}  // namespace microtin::importing

#endif
