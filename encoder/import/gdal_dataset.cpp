// SPDX-License-Identifier: MIT
// Opens files by GDAL. Which drivers it may use is decided here.
#include "encoder/import/gdal_dataset.hpp"

#include <cpl_error.h>
#include <cpl_string.h>

#include <algorithm>
#include <iterator>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"

namespace microtin::importing {
namespace {

// Drivers whose files hold their content themselves. Others read whatever files theirs name (VRT,
// labels with a raster apart), the network or memory.
constexpr const char* kRasterDrivers[] = {
    "GTiff", "AAIGrid", "GRASSASCIIGrid", "SRTMHGT", "USGSDEM", "DTED",   "AIG", "EHdr",
    "BT",    "GSAG",    "GSBG",           "GS7BG",   "GRIB",    "netCDF", "XYZ"};
constexpr const char* kVectorDrivers[] = {"GPKG", "ESRI Shapefile", "FlatGeobuf", "KML", "GPX",
                                          "DXF",  "OpenFileGDB",    "DGN"};

bool is_allowed(const std::string& driver, Indirect indirect, GdalKind kind) {
  const auto is_one_of = [&](const auto& drivers) {
    return std::find(std::begin(drivers), std::end(drivers), driver) != std::end(drivers);
  };
  if (kind == GdalKind::kRaster) {
    return is_one_of(kRasterDrivers) || (driver == "VRT" && indirect == Indirect::kAllowed);
  }
  return is_one_of(kVectorDrivers) || (driver == "OGR_VRT" && indirect == Indirect::kAllowed);
}

// Drivers that are not allowed are gone altogether: those that are open other files by name.
void register_drivers(Indirect indirect, GdalKind kind) {
  GDALAllRegister();
  for (int i = GDALGetDriverCount(); i-- > 0;) {
    const GDALDriverH driver = GDALGetDriver(i);
    if (!is_allowed(GDALGetDriverShortName(driver), indirect, kind)) GDALDeregisterDriver(driver);
  }
}

// Names that GDAL does not give to the file system, also within those of parts of a file.
bool is_virtual(const std::string& path) {
  const size_t at = path.find("/vsi");
  return at == 0 || (at != path.npos && (path[at - 1] == ':' || path[at - 1] == '"'));
}

// GDAL's own words, which begin with the file's name in one way or another. It may know formats
// whose drivers are gone.
std::string reason(const std::string& path, GdalKind kind) {
  std::string text = CPLGetLastErrorMsg();
  for (const std::string& name : {path + ": ", '`' + path + "' ", '\'' + path + "' "}) {
    if (text.compare(0, name.size(), name) == 0) text.erase(0, name.size());
  }
  if (text.find("not recognized as") == text.npos) return text;
  return text + (kind == GdalKind::kRaster
                     ? " convert other formats with \"gdal_translate IN OUT.tif\""
                     : " convert other formats with \"ogr2ogr OUT.gpkg IN\"");
}

}  // namespace

GdalDataset open_gdal_dataset(const std::string& path, Indirect indirect, GdalKind kind) {
  register_drivers(indirect, kind);
  CPLSetErrorHandler(CPLQuietErrorHandler);
  if (indirect == Indirect::kRefused && is_virtual(path)) {
    throw Error("is a virtual file of GDAL's, which is read only with " + parameter("allow_vrt"));
  }
  const unsigned content = kind == GdalKind::kRaster ? GDAL_OF_RASTER : GDAL_OF_VECTOR;
  GdalDataset dataset(GDALOpenEx(path.c_str(), content | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                                 nullptr, nullptr, nullptr));
  if (dataset) return dataset;
  if (suffix_of(path) == ".vrt" && indirect == Indirect::kRefused) {
    throw Error("names other files, which are read only with " + parameter("allow_vrt"));
  }
  throw Error("GDAL cannot open it: " + reason(path, kind));
}

std::vector<std::string> files_of_dataset(const GdalDataset& dataset) {
  std::vector<std::string> files;
  char** const list = GDALGetFileList(dataset.get());
  for (char** file = list; file != nullptr && *file != nullptr; ++file) files.emplace_back(*file);
  CSLDestroy(list);
  return files;
}

}  // namespace microtin::importing
