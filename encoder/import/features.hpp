// SPDX-License-Identifier: MIT
// Files of polygons, lines and points: GeoJSON, and in builds with GDAL what it opens.
#ifndef MICROTIN_ENCODER_IMPORT_FEATURES_HPP
#define MICROTIN_ENCODER_IMPORT_FEATURES_HPP

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "encoder/exact/decimal.hpp"
#include "encoder/import/import.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/polygons.hpp"
#include "encoder/terrain/source.hpp"

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

// Texts by the names of the files that they stand for.
using FileTexts = std::map<std::string, std::string>;

class FeatureFiles {
 public:
  // `texts` are GeoJSON; null: all files are read.
  explicit FeatureFiles(Indirect indirect = Indirect::kRefused,
                        std::shared_ptr<const FileTexts> texts = nullptr)
      : indirect_(indirect), texts_(std::move(texts)) {}

  // Features in the terrain's own system. Throws Error naming the file.
  std::vector<Feature> read(const std::string& path) const;

  // Throws Error naming the file if it states another horizontal system than `terrain`. GeoJSON
  // counts as being in the terrain's.
  void expect_system(const std::string& path, const Reference& terrain) const;

  // Whether GDAL reads the file: it has no text here, and a suffix that is not one of GeoJSON or of
  // texts. Throws Error in builds without GDAL if the suffix is one of GDAL's formats.
  bool is_for_gdal(const std::string& path) const;

  // Whether a file has features by its suffix, and so is not a raster.
  bool has_features(const std::string& path) const;

  // All files that a file is read from: more than one by GDAL, where GDAL can open it.
  std::vector<std::string> files_of(const std::string& path) const;

 private:
  const std::string* text_of(const std::string& path) const;

  [[maybe_unused]] Indirect indirect_;  // of files by GDAL
  std::shared_ptr<const FileTexts> texts_;
};

// Reads the features of a GeoJSON text: collections, features and geometries. Coordinates are
// numbers of the terrain's own system. Throws Error with the line of a fault.
std::vector<Feature> import_geojson(const std::string& name, std::string_view text);

// Whether a file of that name is GeoJSON: .geojson or .json.
bool is_geojson(const std::string& path);

#ifdef MICROTIN_WITH_GDAL
// The features of the layer that has some. Curves become lines, and parts that are empty are left
// out. Fields have the names of GeoJSON's properties. Coordinates stand for the shortest decimals
// that become them.
std::vector<Feature> import_gdal_features(const std::string& path, Indirect indirect);
void expect_gdal_system(const std::string& path, Indirect indirect, const Reference& terrain);
std::vector<std::string> gdal_feature_files(const std::string& path, Indirect indirect);
#endif

}  // namespace microtin::importing

#endif
