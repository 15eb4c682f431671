// SPDX-License-Identifier: MIT
// Towers, power lines and cranes over a terrain.
#ifndef MICROTIN_ENCODER_IMPORT_OBSTACLES_HPP
#define MICROTIN_ENCODER_IMPORT_OBSTACLES_HPP

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "encoder/exact/decimal.hpp"
#include "encoder/import/features.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/raster_reader.hpp"

namespace microtin::importing {

class Obstacles {
 public:
  // Reads a file: points, lines and polygons with a `top` above the zero of the terrain's
  // heights, or a `height` above the ground, and a `radius` in metres. Throws Error naming it.
  Obstacles(const std::string& path, const FeatureFiles& files);

  // A raster whose posts are raised when it is read: all those of each cell that an obstacle
  // touches to its top at least; void posts stay void. `max_error` is the bound of posts that have
  // none of their own. Posts near raised ones get wider bounds. The frame counts the obstacles.
  // Reads the posts that obstacles touch, once or twice. Throws Error naming the file. Takes
  // O(posts that are raised) of memory.
  std::unique_ptr<terrain::RasterReader> raised(std::unique_ptr<terrain::RasterReader> ground,
                                                const std::optional<Decimal>& max_error) const;

 private:
  std::string path_;
  std::vector<Feature> features_;
};

}  // namespace microtin::importing

#endif
