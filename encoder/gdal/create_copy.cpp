// SPDX-License-Identifier: MIT
// Encodes a raster of GDAL's: gdal_translate -of MTIN.
#include <cctype>
#include <cstring>
#include <limits>
#include <map>
#include <microtin/encoder.hpp>
#include <stdexcept>

#include "encoder/gdal/dataset.hpp"

namespace microtin::gdal {
namespace {

using encoder::RasterData;
using encoder::Transform;

[[noreturn]] void refuse(const std::string& why) {
  throw std::runtime_error(why);
}

// As driver.cpp describes them.
constexpr const char* kCreationOptions[] = {
    "MAX_ERROR",   "MAX_VERTICES",     "MAX_BYTES",   "NEVER_BELOW",
    "Z_STEP",      "XY_STEP",          "EFFORT",      "CODING",
    "MAX_DEGREE",  "TILE_VERTICES",    "TILE_SIZE",   "UNITS",
    "DEPTHS",      "SURFACE",          "SOURCE_NAME", "DATE",
    "LINEAGE",     "ATTRIBUTION",      "LICENSE",     "VALID",
    "EPOCH",       "SOURCE_ACCURACY",  "DIGEST",      "PHASES",
    "ERROR_MAP",   "BOUND_AT",         "AREA",        "ROUTE",
    "ROUTE_WIDTH", "ROUTE_EDGE_ERROR", "BREAKLINES",  "OBSTACLES"};

std::string lower_case(std::string text) {
  for (char& letter : text)
    letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return text;
}

bool ends_with(const std::string& text, const char* end) {
  const size_t size = std::strlen(end);
  return text.size() >= size && EQUAL(text.c_str() + text.size() - size, end);
}

Transform transform_of(GDALDataset& source) {
  Transform transform{};
  if (source.GetGeoTransform(transform.data()) != CE_None) {
    refuse("the source has no position: add it with -a_ullr WEST NORTH EAST SOUTH");
  }
  if (!encoder::runs_east(transform)) {
    refuse("the source's rows do not run from west to east: bring them there with gdalwarp");
  }
  return transform;
}

template <class Number>
std::vector<Number> heights_of(GDALRasterBand& band, GDALDataType type) {
  const auto columns = static_cast<size_t>(band.GetXSize()),
             rows = static_cast<size_t>(band.GetYSize());
  std::vector<Number> heights(columns * rows);
  if (band.RasterIO(GF_Read, 0, 0, band.GetXSize(), band.GetYSize(), heights.data(),
                    band.GetXSize(), band.GetYSize(), type, 0, 0, nullptr) != CE_None) {
    refuse("the source cannot be read");
  }
  // Whatever the source marks its voids by: a value, a mask, transparency.
  std::vector<uint8_t> mask(columns);
  for (size_t row = 0; row < rows && band.GetMaskFlags() != GMF_ALL_VALID; ++row) {
    if (band.GetMaskBand()->RasterIO(GF_Read, 0, static_cast<int>(row), band.GetXSize(), 1,
                                     mask.data(), band.GetXSize(), 1, GDT_Byte, 0, 0,
                                     nullptr) != CE_None) {
      refuse("the source's mask cannot be read");
    }
    for (size_t column = 0; column < columns; ++column) {
      if (mask[column] == 0) {
        heights[row * columns + column] = std::numeric_limits<Number>::quiet_NaN();
      }
    }
  }
  return heights;
}

// Nothing is known of a source in memory, which is what its files hold.
void expect_held(GDALDataset& source) {
  char** const files = source.GetFileList();
  uint64_t bytes = 0;
  for (char** file = files; file != nullptr && *file != nullptr; ++file) {
    VSIStatBufL status;
    if (VSIStatL(*file, &status) == 0) bytes += static_cast<uint64_t>(status.st_size);
  }
  const bool has_files = files != nullptr && *files != nullptr;
  CSLDestroy(files);
  const auto columns = static_cast<uint32_t>(source.GetRasterXSize()),
             rows = static_cast<uint32_t>(source.GetRasterYSize());
  if (!has_files || encoder::can_hold(bytes, columns, rows)) return;
  refuse("the source's " + std::to_string(bytes) + " bytes cannot hold " + std::to_string(columns) +
         " x " + std::to_string(rows) + " posts: cut it with -projwin WEST NORTH EAST SOUTH");
}

RasterData raster_from_cells(GDALDataset& source) {
  if (source.GetRasterCount() != 1) {
    refuse("the source has not one band but " + std::to_string(source.GetRasterCount()) +
           ": choose one with -b");
  }
  GDALRasterBand& band = *source.GetRasterBand(1);
  if (band.GetScale() != 1 || band.GetOffset() != 0) {
    refuse("the source's heights have a scale or an offset: apply them with -unscale");
  }
  expect_held(source);
  const Transform transform = transform_of(source);
  const auto columns = static_cast<uint32_t>(band.GetXSize()),
             rows = static_cast<uint32_t>(band.GetYSize());
  const GDALDataType type = band.GetRasterDataType();
  const char* const bytes = band.GetMetadataItem("PIXELTYPE", "IMAGE_STRUCTURE");
  if (bytes != nullptr && EQUAL(bytes, "SIGNEDBYTE")) {
    refuse(
        "heights are signed bytes, which GDAL reads as unsigned: make them wider with "
        "gdal_calc.py");
  }
  if (GDALDataTypeIsComplex(type) != 0) {
    refuse("heights are complex numbers: take their real parts with -ot Float64");
  }
  int has_value = 0;
  const double value = band.GetNoDataValue(&has_value);
  // If the file has a mask, GDAL passes the value over.
  const double no_data = has_value != 0 ? value : encoder::kNoValue;
  if (type == GDT_Float32) {
    return encoder::raster_from_cells(columns, rows, heights_of<float>(band, GDT_Float32).data(),
                                      transform, no_data);
  }
  return encoder::raster_from_cells(columns, rows, heights_of<double>(band, GDT_Float64).data(),
                                    transform, no_data);
}

std::string wkt_of(const GDALDataset& source) {
  const OGRSpatialReference* const system = source.GetSpatialRef();
  char* text = nullptr;
  if (system == nullptr || system->exportToWkt(&text) != OGRERR_NONE) {
    CPLFree(text);
    return "";
  }
  std::string wkt = text;
  CPLFree(text);
  return wkt;
}

// What the source's file states about itself.
std::map<std::string, std::string> items_of(GDALDataset& source) {
  std::map<std::string, std::string> items;
  char** const list = source.GetMetadata();
  for (int i = 0; i < CSLCount(list); ++i) {
    char* name = nullptr;
    const char* const value = CPLParseNameValue(list[i], &name);
    if (name != nullptr && value != nullptr) items[name] = value;
    CPLFree(name);
  }
  const OGRSpatialReference* const system = source.GetSpatialRef();
  const double epoch = system != nullptr ? system->GetCoordinateEpoch() : 0;
  if (epoch > 0) items["COORDINATE_EPOCH"] = CPLSPrintf("%.9f", epoch);
  return items;
}

// GDAL's names are those of the library in capitals; it knows several words for true and false.
encoder::Options options_of(char** given) {
  encoder::Options options;
  for (const char* const name : kCreationOptions) {
    const char* const value = CSLFetchNameValue(given, name);
    if (value == nullptr) continue;
    const bool is_flag = EQUAL(name, "NEVER_BELOW") || EQUAL(name, "DEPTHS") ||
                         EQUAL(name, "DIGEST") || EQUAL(name, "PHASES");
    const std::string text = is_flag ? (CPLTestBool(value) ? "true" : "false") : value;
    const bool is_choice = EQUAL(name, "EFFORT") || EQUAL(name, "CODING") ||
                           EQUAL(name, "SURFACE") || EQUAL(name, "BOUND_AT");
    encoder::set_option(options, lower_case(name), is_choice ? lower_case(text) : text);
  }
  return options;
}

bool is_geojson(const std::string& path) {
  return ends_with(path, ".geojson") || ends_with(path, ".json");
}

bool is_text_of_lines(const std::string& path) {
  return ends_with(path, ".csv") || ends_with(path, ".txt") || ends_with(path, ".xyz") ||
         ends_with(path, ".dat");
}

void take_features(const std::string& path, GDALDataset& features,
                   const OGRSpatialReference* system, encoder::SourceTerrain& terrain) {
  try {
    terrain.set_features(path, geojson_of(features, system));
  } catch (const std::runtime_error& error) {
    refuse(path + ": " + error.what());
  }
}

// Files that the library does not read by itself are read by GDAL.
void take_files(encoder::Options& options, const OGRSpatialReference* system,
                encoder::SourceTerrain& terrain) {
  for (const std::string& path :
       {options.area, options.route, options.obstacles, options.breaklines}) {
    if (path.empty() || is_geojson(path)) continue;
    if (path == options.breaklines && is_text_of_lines(path)) continue;
    const GDALDatasetUniquePtr features(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR));
    if (!features) refuse(path + ": has no polygons, lines or points that GDAL reads");
    take_features(path, *features, system, terrain);
  }
  const std::string path = options.error_map;
  if (path.empty() || is_geojson(path)) return;
  const GDALDatasetUniquePtr map(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_VECTOR));
  if (!map) refuse(path + ": is neither a raster of bounds nor a file of polygons");
  if (map->GetRasterCount() == 0) {
    take_features(path, *map, system, terrain);
    return;
  }
  terrain.set_error_map(raster_from_cells(*map));
  options.error_map.clear();
}

void write_bytes(const char* path, const std::vector<uint8_t>& bytes) {
  VSILFILE* const file = VSIFOpenL(path, "wb");
  if (file == nullptr) refuse(std::string(path) + ": cannot be written");
  const bool is_written = VSIFWriteL(bytes.data(), 1, bytes.size(), file) == bytes.size();
  if (VSIFCloseL(file) == 0 && is_written) return;
  VSIUnlink(path);
  refuse(std::string(path) + ": cannot be written");
}

encoder::Report encode(const char* path, GDALDataset& source, char** given,
                       const encoder::Callbacks& callbacks) {
  if (!ends_with(path, ".mtin") && !ends_with(path, ".mtp")) {
    refuse(std::string(path) + ": name a stream .mtin or a pack .mtp");
  }
  RasterData posts = raster_from_cells(source);
  posts.wkt = wkt_of(source);
  posts.z_unit = source.GetRasterBand(1)->GetUnitType();
  posts.items = items_of(source);
  encoder::SourceTerrain terrain(std::move(posts));
  encoder::Options options = options_of(given);
  take_files(options, source.GetSpatialRef(), terrain);
  if (!ends_with(path, ".mtp")) {
    encoder::Stream stream = encoder::encode_stream(terrain, options, callbacks);
    write_bytes(path, stream.bytes);
    return std::move(stream.report);
  }
  if (STARTS_WITH(path, "/vsi")) refuse("a pack cannot be written to /vsi...; name a file");
  return encoder::encode_pack(terrain, options, path, callbacks);
}

}  // namespace

GDALDataset* create_copy(const char* path, GDALDataset* source, int /*strict*/, char** options,
                         GDALProgressFunc progress, void* context) {
  encoder::Callbacks callbacks;
  callbacks.progress = [&](double done) {
    if (progress(done, "", context) == 0) throw encoder::Cancelled();
  };
  return guarded(
      [&]() -> GDALDataset* {
        const encoder::Report report = encode(path, *source, options, callbacks);
        for (const std::string& warning : report.warnings) {
          CPLError(CE_Warning, CPLE_AppDefined, "MTIN: %s: %s", path, warning.c_str());
        }
        progress(1, "", context);
        GDALOpenInfo info(path, GDAL_OF_RASTER);
        return Dataset::open(&info);
      },
      static_cast<GDALDataset*>(nullptr));
}

}  // namespace microtin::gdal
