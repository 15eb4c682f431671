// SPDX-License-Identifier: MIT
// Chooses the reader of a file of features by its suffix.
#include "encoder/import/features.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/files/input.hpp"
#include "encoder/import/crs.hpp"
#include "encoder/terrain/degrees.hpp"

namespace microtin::importing {
namespace {

template <std::size_t count>
bool has_suffix(const std::string& path, const char* const (&suffixes)[count]) {
  return std::find(std::begin(suffixes), std::end(suffixes), suffix_of(path)) != std::end(suffixes);
}

// Formats whose files hold features, not rasters.
constexpr const char* kOfGdal[] = {".gpkg", ".shp", ".shz", ".fgb", ".kml",
                                   ".gpx",  ".dxf", ".dgn", ".gdb"};

#ifdef MICROTIN_WITH_GDAL
// GeoJSON, and texts of breaklines.
constexpr const char* kOwn[] = {"", ".geojson", ".json", ".csv", ".txt", ".xyz", ".dat"};
#endif

// The first position of a line that there is not in degrees, or empty.
std::string beyond_of_line(const RealLine& line) {
  for (const RealPoint& point : line) {
    for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
      std::string beyond = terrain::beyond_degrees(axis, axis == 0 ? point.x : point.y);
      if (!beyond.empty()) return beyond;
    }
  }
  return "";
}

std::string beyond_of(const std::vector<Feature>& features) {
  for (const Feature& feature : features) {
    std::string beyond = beyond_of_line(feature.points);
    if (beyond.empty()) beyond = beyond_earth(feature.lines);
    for (const RealRings& rings : feature.polygons) {
      if (beyond.empty()) beyond = beyond_earth(rings);
    }
    if (!beyond.empty()) return beyond;
  }
  return "";
}

void expect_code(const StatedSystem& file, const Reference& terrain) {
  const uint32_t code = file.horizontal_epsg, expected = terrain.horizontal_epsg;
  const std::optional<CodedSystem> system = system_of_file_code(code);
  const bool has_other_unit = system && terrain.horizontal_unit != Unit::kUnknown &&
                              system->unit != terrain.horizontal_unit;
  if (code == 0 || ((expected == 0 || code == expected) && !has_other_unit)) return;
  const std::string target = expected != 0 ? "EPSG:" + std::to_string(expected) : "TERRAIN.prj";
  throw Error("its coordinate system (" + file.name + ") is not the terrain's (" +
              (expected != 0 ? target : "unit " + std::string(name_of(terrain.horizontal_unit))) +
              "): transform it with \"ogr2ogr -t_srs " + target + " OUT.geojson IN\"");
}

void expect_unit(const char* what, const StatedUnit& file, Unit terrain) {
  if (!file.is_stated() || terrain == Unit::kUnknown || file.unit == terrain) return;
  throw Error(std::string(what) + " are in the unit " +
              (file.other.empty() ? std::string(name_of(file.unit)) : file.other) +
              ", and those of the terrain in " + std::string(name_of(terrain)) + ": convert them");
}

void expect_units(const StatedSystem& file, const Reference& terrain) {
  expect_unit("x and y", file.horizontal, terrain.horizontal_unit);
  expect_unit("heights", file.vertical, terrain.vertical_unit);
  if (file.is_depth)
    throw Error("the lines have depths, which grow downwards: write heights in their place");
}

}  // namespace

std::string beyond_earth(const std::vector<RealLine>& lines) {
  for (const RealLine& line : lines) {
    std::string beyond = beyond_of_line(line);
    if (!beyond.empty()) return beyond;
  }
  return "";
}

const std::string* FeatureFiles::text_of(const std::string& path) const {
  if (texts_ == nullptr) return nullptr;
  const auto found = texts_->find(path);
  return found == texts_->end() ? nullptr : &found->second;
}

bool FeatureFiles::is_for_gdal(const std::string& path) const {
  if (path == "-" || text_of(path) != nullptr) return false;
#ifdef MICROTIN_WITH_GDAL
  return !has_suffix(path, kOwn);
#else
  if (!has_suffix(path, kOfGdal)) return false;
  throw Error(path +
              ": is not GeoJSON; convert it with \"ogr2ogr OUT.geojson IN\", or build with "
              "-DMICROTIN_WITH_GDAL=ON");
#endif
}

bool FeatureFiles::has_features(const std::string& path) const {
  return text_of(path) != nullptr || is_geojson(path) || has_suffix(path, kOfGdal);
}

FeatureFile FeatureFiles::parsed(const std::string& path) const {
  if (const std::string* const text = text_of(path)) return import_geojson(path, *text);
#ifdef MICROTIN_WITH_GDAL
  if (is_for_gdal(path)) return {import_gdal_features(path, indirect_), {}};
#else
  is_for_gdal(path);  // throws Error if only GDAL can read it
#endif
  return import_geojson(path, read_file(path));
}

std::vector<Feature> FeatureFiles::read(const std::string& path) const {
  if (const auto known = kept_->files.find(path); known != kept_->files.end()) {
    std::optional<std::vector<Feature>> features = std::exchange(known->second.features, {});
    if (features) return std::move(*features);
  }
  FeatureFile file = parsed(path);
  note(path, file.stated, beyond_of(file.features));
  return std::move(file.features);
}

void FeatureFiles::note(const std::string& path, const StatedSystem& stated,
                        const std::string& beyond) const {
  kept_->files[path] = {stated, beyond, {}};
}

bool FeatureFiles::is_noted(const std::string& path) const {
  return kept_->files.count(path) != 0;
}

void FeatureFiles::expect_system(const std::string& path, const Reference& terrain) const {
#ifdef MICROTIN_WITH_GDAL
  if (is_for_gdal(path)) expect_gdal_system(path, indirect_, terrain);
#endif
  if (!is_noted(path)) {
    FeatureFile file = parsed(path);
    note(path, file.stated, beyond_of(file.features));
    kept_->files[path].features = std::move(file.features);
  }
  const ReadFeatures::File& file = kept_->files[path];
  with_file_context(path, [&] {
    expect_code(file.stated, terrain);
    expect_units(file.stated, terrain);
    if (terrain.horizontal_unit != Unit::kDegree || file.beyond.empty()) return;
    throw Error(file.beyond + ", and the terrain is in degrees: x is the longitude and y the " +
                "latitude; exchange them, or transform the file with \"ogr2ogr -t_srs\"");
  });
}

std::vector<std::string> FeatureFiles::files_of(const std::string& path) const {
#ifdef MICROTIN_WITH_GDAL
  if (is_for_gdal(path)) return gdal_feature_files(path, indirect_);
#endif
  return {path};
}

}  // namespace microtin::importing
