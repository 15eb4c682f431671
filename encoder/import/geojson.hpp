// SPDX-License-Identifier: MIT
// Polygons, lines and points out of GeoJSON files.
#ifndef MICROTIN_ENCODER_IMPORT_GEOJSON_HPP
#define MICROTIN_ENCODER_IMPORT_GEOJSON_HPP

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/exact/decimal.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/polygons.hpp"

namespace microtin::importing {

struct Feature {
  std::vector<RealRings> polygons;
  std::vector<RealLine> lines;
  std::vector<RealPoint> points;
  // The property max_error: a number from 0 up, or null, which leaves places without a bound.
  bool has_max_error = false;
  std::optional<Decimal> max_error;
  // Properties of obstacles: a height above the zero of heights, or from 0 up above the ground; and
  // metres from 0 up around the geometry.
  std::optional<Decimal> top, height, radius;
  // The property class of lines: a text, and the place where it stands, "a.geojson:3".
  std::string line_class, place_of_class;
};

// Reads the features of a GeoJSON text: collections, features and geometries. Coordinates are
// numbers of the terrain's own system. Throws Error with the line of a fault.
std::vector<Feature> import_geojson(const std::string& name, std::string_view text);

// Whether a file of that name is GeoJSON: .geojson or .json.
bool is_geojson(const std::string& path);

}  // namespace microtin::importing

#endif
