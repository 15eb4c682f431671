// SPDX-License-Identifier: MIT
// Files of polygons, lines and points: GeoJSON, and in builds with GDAL what it opens.
#ifndef MICROTIN_ENCODER_IMPORT_FEATURES_HPP
#define MICROTIN_ENCODER_IMPORT_FEATURES_HPP

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "encoder/exact/decimal.hpp"
#include "encoder/exact/units.hpp"
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

// In which system and units a file of features states that it is.
struct StatedSystem {
  std::string name;              // of the horizontal system, as the file has it; empty: none
  uint32_t horizontal_epsg = 0;  // its code; 0: it is not known
  StatedUnit horizontal, vertical;
  bool is_depth = false;  // heights are depths
};

struct FeatureFile {
  std::vector<Feature> features;
  StatedSystem stated;
};

// Texts by the names of the files that they stand for.
using FileTexts = std::map<std::string, std::string>;

// What was read of files, by their names. A pipe can be read once only, so that the features of a
// file whose system was looked at are kept until they are requested.
struct ReadFeatures {
  struct File {
    StatedSystem stated;
    std::string beyond;  // a position that there is not in degrees, or empty
    std::optional<std::vector<Feature>> features;
  };
  std::map<std::string, File> files;
};

// The first coordinate of lines that there is not in degrees, "latitude 158 is beyond 90 degrees",
// or empty.
std::string beyond_earth(const std::vector<RealLine>& lines);

class FeatureFiles {
 public:
  // `texts` are GeoJSON; null: all files are read. `kept`: what several of these objects share.
  explicit FeatureFiles(Indirect indirect = Indirect::kRefused,
                        std::shared_ptr<const FileTexts> texts = nullptr,
                        std::shared_ptr<ReadFeatures> kept = std::make_shared<ReadFeatures>())
      : indirect_(indirect), texts_(std::move(texts)), kept_(std::move(kept)) {}

  // Features in the terrain's own system. Throws Error naming the file.
  std::vector<Feature> read(const std::string& path) const;

  // Notes what a text of breaklines states, and `beyond_earth` of its lines, as `read` does.
  void note(const std::string& path, const StatedSystem& stated, const std::string& beyond) const;

  // Whether a file was read, or its system looked at.
  bool is_noted(const std::string& path) const;

  // Throws Error naming the file if it states another system or unit than `terrain`, or if that is
  // in degrees and the file has a position that there is not on Earth. A file that states nothing
  // counts as being in the terrain's system.
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
  FeatureFile parsed(const std::string& path) const;

  [[maybe_unused]] Indirect indirect_;  // of files by GDAL
  std::shared_ptr<const FileTexts> texts_;
  std::shared_ptr<ReadFeatures> kept_;
};

// Reads the features of a GeoJSON text: collections, features and geometries. Coordinates are
// numbers of the terrain's own system. Throws Error with the line of a fault.
FeatureFile import_geojson(const std::string& name, std::string_view text);

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
