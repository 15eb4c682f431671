// SPDX-License-Identifier: MIT
// Chooses the reader of a file of features by its suffix.
#include "encoder/import/features.hpp"

#include <algorithm>
#include <iterator>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/files/input.hpp"

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

}  // namespace

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

std::vector<Feature> FeatureFiles::read(const std::string& path) const {
  if (const std::string* const text = text_of(path)) return import_geojson(path, *text);
#ifdef MICROTIN_WITH_GDAL
  if (is_for_gdal(path)) return import_gdal_features(path, indirect_);
#else
  is_for_gdal(path);  // throws Error if only GDAL can read it
#endif
  return import_geojson(path, read_file(path));
}

void FeatureFiles::expect_system([[maybe_unused]] const std::string& path,
                                 [[maybe_unused]] const Reference& terrain) const {
#ifdef MICROTIN_WITH_GDAL
  if (is_for_gdal(path)) expect_gdal_system(path, indirect_, terrain);
#endif
}

std::vector<std::string> FeatureFiles::files_of(const std::string& path) const {
#ifdef MICROTIN_WITH_GDAL
  if (is_for_gdal(path)) return gdal_feature_files(path, indirect_);
#endif
  return {path};
}

}  // namespace microtin::importing
