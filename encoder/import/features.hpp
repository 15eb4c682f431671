// SPDX-License-Identifier: MIT
// Files of polygons, lines and points: GeoJSON, and in builds with GDAL what it opens.
#ifndef MICROTIN_ENCODER_IMPORT_FEATURES_HPP
#define MICROTIN_ENCODER_IMPORT_FEATURES_HPP

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "encoder/import/geojson.hpp"
#include "encoder/import/import.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::importing {

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
