// SPDX-License-Identifier: MIT
// Polygons, lines and points that GDAL opens; part of builds with MICROTIN_WITH_GDAL only.
#include <cpl_error.h>
#include <cpl_port.h>
#include <gdal.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/exact/decimal.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/files/input.hpp"
#include "encoder/import/features.hpp"
#include "encoder/import/gdal_dataset.hpp"

namespace microtin::importing {
namespace {

namespace fs = std::filesystem;

struct DestroyFeature {
  void operator()(void* feature) const { OGR_F_Destroy(feature); }
};
using OwnedFeature = std::unique_ptr<void, DestroyFeature>;

struct DestroyGeometry {
  void operator()(void* geometry) const { OGR_G_DestroyGeometry(geometry); }
};

struct ReleaseSystem {
  void operator()(void* system) const { OSRRelease(system); }
};
using OwnedSystem = std::unique_ptr<void, ReleaseSystem>;

// A pipe or a device is refused here: the message of GDAL would name no remedy.
GdalDataset open(const std::string& path, Indirect indirect) {
  std::error_code none;
  if (fs::exists(fs::u8path(path), none) && !fs::is_directory(fs::u8path(path), none)) {
    open_file(path);  // throws Error if it cannot be read in pieces
  }
  return with_file_context(path,
                           [&] { return open_gdal_dataset(path, indirect, GdalKind::kVector); });
}

// The geometry of a feature; null: it has none, or it is empty.
OGRGeometryH geometry_of(const OwnedFeature& feature) {
  const OGRGeometryH geometry = OGR_F_GetGeometryRef(feature.get());
  return geometry == nullptr || OGR_G_IsEmpty(geometry) != 0 ? nullptr : geometry;
}

// Calls visit(feature) for each one until that returns false. Throws Error if the file is damaged.
template <class Visit>
void visit_features(OGRLayerH layer, const Visit& visit) {
  CPLErrorReset();
  OGR_L_ResetReading(layer);
  OwnedFeature feature(OGR_L_GetNextFeature(layer));
  while (feature && visit(feature)) feature.reset(OGR_L_GetNextFeature(layer));
  if (CPLGetLastErrorType() >= CE_Failure) {
    throw Error(std::string("cannot be read: ") + CPLGetLastErrorMsg());
  }
}

bool has_geometry(OGRLayerH layer) {
  bool is_found = false;
  visit_features(layer, [&](const OwnedFeature& feature) {
    is_found = geometry_of(feature) != nullptr;
    return !is_found;
  });
  return is_found;
}

// Whether a layer of GPX has the points of the lines in another one.
bool repeats_another(OGRLayerH layer) {
  return EQUAL(OGR_L_GetName(layer), "route_points") || EQUAL(OGR_L_GetName(layer), "track_points");
}

// The layer that has geometries. Null: there is none.
OGRLayerH layer_of(const GdalDataset& dataset) {
  OGRLayerH only = nullptr;
  std::string names;
  int count = 0;
  const bool is_gpx = EQUAL(GDALGetDriverShortName(GDALGetDatasetDriver(dataset.get())), "GPX");
  for (int i = 0; i < GDALDatasetGetLayerCount(dataset.get()); ++i) {
    const OGRLayerH layer = GDALDatasetGetLayer(dataset.get(), i);
    if (layer == nullptr || (is_gpx && repeats_another(layer)) || !has_geometry(layer)) continue;
    only = layer;
    names += (count++ == 0 ? "" : ", ") + std::string(OGR_L_GetName(layer));
  }
  if (count <= 1) return only;
  throw Error("has " + std::to_string(count) + " layers with geometries (" + names +
              "): copy one of them with \"ogr2ogr OUT.gpkg IN LAYER\"");
}

Decimal coordinate_of(double value) {
  const std::optional<Decimal> coordinate = exact::shortest_decimal(value, exact::kPlaceDecimals);
  if (!coordinate) throw Error("a coordinate is not a number, or out of range");
  return *coordinate;
}

RealLine line_of(OGRGeometryH geometry) {
  const bool has_heights = OGR_G_Is3D(geometry) != 0;
  RealLine line;
  for (int i = 0; i < OGR_G_GetPointCount(geometry); ++i) {
    RealPoint point{coordinate_of(OGR_G_GetX(geometry, i)), coordinate_of(OGR_G_GetY(geometry, i))};
    if (has_heights) point.z = coordinate_of(OGR_G_GetZ(geometry, i));
    line.push_back(point);
  }
  return line;
}

RealRings rings_of(OGRGeometryH polygon) {
  OGR_G_CloseRings(polygon);
  RealRings rings;
  for (int i = 0; i < OGR_G_GetGeometryCount(polygon); ++i) {
    RealLine ring = line_of(OGR_G_GetGeometryRef(polygon, i));
    if (ring.empty()) continue;
    if (ring.size() < 4) throw Error("a ring of a polygon has fewer than four positions");
    rings.push_back(std::move(ring));
  }
  return rings;
}

constexpr int kDeepestCollection = 32;  // collections within each other

void add_geometry(OGRGeometryH geometry, int depth, Feature& feature) {
  if (OGR_G_IsEmpty(geometry) != 0) return;
  if (depth > kDeepestCollection) throw Error("has too many collections within each other");
  const OGRwkbGeometryType type = OGR_GT_Flatten(OGR_G_GetGeometryType(geometry));
  if (type == wkbPoint) {
    feature.points.push_back(line_of(geometry).at(0));
  } else if (type == wkbLineString) {
    feature.lines.push_back(line_of(geometry));
    if (feature.lines.back().size() < 2) throw Error("a line has fewer than two positions");
  } else if (type == wkbPolygon) {
    feature.polygons.push_back(rings_of(geometry));
  } else if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection) != 0) {
    for (int i = 0; i < OGR_G_GetGeometryCount(geometry); ++i) {
      add_geometry(OGR_G_GetGeometryRef(geometry, i), depth + 1, feature);
    }
  } else {
    throw Error(std::string("is a ") + OGRGeometryTypeToName(type) +
                ": convert it with \"ogr2ogr -nlt MULTIPOLYGON OUT.gpkg IN\"");
  }
}

class RowReader {
 public:
  RowReader(const std::string& path, OGRLayerH layer)
      : path_(path), fields_(OGR_L_GetLayerDefn(layer)) {}

  Feature read(const OwnedFeature& from, OGRGeometryH geometry) const {
    Feature feature;
    // Curves become lines of GDAL's usual steps, 4 degrees.
    if (OGR_G_HasCurveGeometry(geometry, 0) != 0) {
      const std::unique_ptr<void, DestroyGeometry> lines(
          OGR_G_GetLinearGeometry(geometry, 0, nullptr));
      if (!lines) throw Error("has a curve that GDAL cannot convert to lines");
      add_geometry(lines.get(), 0, feature);
    } else {
      add_geometry(geometry, 0, feature);
    }
    feature.top = number_of(from, "top", true);
    feature.height = number_of(from, "height", false);
    feature.radius = number_of(from, "radius", false);
    feature.max_error = number_of(from, "max_error", false);
    feature.has_max_error = field_of("max_error") >= 0;
    const int kind = field_of("class");
    if (is_set(from, kind)) {
      feature.line_class = OGR_F_GetFieldAsString(from.get(), kind);
      feature.place_of_class = path_ + ": " + name_of(from);
    }
    return feature;
  }

  static std::string name_of(const OwnedFeature& feature) {
    return "feature " + std::to_string(OGR_F_GetFID(feature.get()));
  }

 private:
  int field_of(const char* name) const { return OGR_FD_GetFieldIndex(fields_, name); }

  OGRFieldType type_of(int field) const {
    return OGR_Fld_GetType(OGR_FD_GetFieldDefn(fields_, field));
  }

  static bool is_set(const OwnedFeature& feature, int field) {
    return field >= 0 && OGR_F_IsFieldSetAndNotNull(feature.get(), field) != 0;
  }

  std::optional<Decimal> number_of(const OwnedFeature& feature, const char* name,
                                   bool is_negative_allowed) const {
    const int field = field_of(name);
    if (!is_set(feature, field)) return std::nullopt;
    const std::optional<Decimal> number = decimal_of(feature, field);
    if (number && (is_negative_allowed || number->mantissa >= 0)) return number;
    throw Error(std::string(name) + " is not a number" + (is_negative_allowed ? "" : " from 0 up"));
  }

  std::optional<Decimal> decimal_of(const OwnedFeature& feature, int field) const {
    const OGRFieldType type = type_of(field);
    if (type == OFTInteger || type == OFTInteger64) {
      return exact::parse_decimal(std::to_string(OGR_F_GetFieldAsInteger64(feature.get(), field)));
    }
    if (type != OFTReal) return std::nullopt;
    const double value = OGR_F_GetFieldAsDouble(feature.get(), field);
    const bool is_float = OGR_Fld_GetSubType(OGR_FD_GetFieldDefn(fields_, field)) == OFSTFloat32;
    return is_float ? exact::shortest_decimal(static_cast<float>(value))
                    : exact::shortest_decimal(value);
  }

  std::string path_;
  OGRFeatureDefnH fields_;
};

std::vector<Feature> read(const std::string& path, const GdalDataset& dataset) {
  std::vector<Feature> features;
  const OGRLayerH layer = layer_of(dataset);
  if (layer == nullptr) return features;
  const RowReader reader(path, layer);
  visit_features(layer, [&](const OwnedFeature& feature) {
    const OGRGeometryH geometry = geometry_of(feature);
    if (geometry == nullptr) return true;
    features.push_back(with_file_context(RowReader::name_of(feature),
                                         [&] { return reader.read(feature, geometry); }));
    return true;
  });
  return features;
}

// The terrain's horizontal system. Null: it is not known.
OwnedSystem system_of(const Reference& terrain) {
  OwnedSystem system(OSRNewSpatialReference(nullptr));
  OGRErr error = OGRERR_FAILURE;
  if (terrain.horizontal_epsg != 0) {
    error = OSRImportFromEPSG(system.get(), static_cast<int>(terrain.horizontal_epsg));
  } else if (!terrain.wkt.empty()) {
    error = OSRSetFromUserInput(system.get(), terrain.wkt.c_str());
  }
  return error == OGRERR_NONE ? std::move(system) : nullptr;
}

std::string name_of(OGRSpatialReferenceH system) {
  const char* const name = OSRGetName(system);
  const char* const code = OSRGetAuthorityCode(system, nullptr);
  const char* const authority = OSRGetAuthorityName(system, nullptr);
  const std::string text = name != nullptr ? name : "unnamed";
  return code == nullptr || authority == nullptr ? text : text + ", " + authority + ':' + code;
}

// A GeoPackage without a system states one with such a name.
bool is_undefined(OGRSpatialReferenceH system) {
  const char* const name = OSRGetName(system);
  return name != nullptr && STARTS_WITH(name, "Undefined ");
}

bool are_same(OGRSpatialReferenceH a, OGRSpatialReferenceH b) {
  const char* const options[] = {"IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES",
                                 "IGNORE_COORDINATE_EPOCH=YES", nullptr};
  return OSRIsSameEx(a, b, options) != 0;
}

}  // namespace

std::vector<Feature> import_gdal_features(const std::string& path, Indirect indirect) {
  const GdalDataset dataset = open(path, indirect);
  return with_file_context(path, [&] { return read(path, dataset); });
}

void expect_gdal_system(const std::string& path, Indirect indirect, const Reference& terrain) {
  const GdalDataset dataset = open(path, indirect);
  with_file_context(path, [&] {
    const OGRLayerH layer = layer_of(dataset);
    const OGRSpatialReferenceH stated = layer != nullptr ? OGR_L_GetSpatialRef(layer) : nullptr;
    const OwnedSystem expected = system_of(terrain);
    if (stated == nullptr || is_undefined(stated) || !expected) return;
    const OwnedSystem found(OSRClone(stated));
    OSRStripVertical(found.get());
    OSRDemoteTo2D(found.get(), nullptr);
    OSRStripVertical(expected.get());
    if (are_same(found.get(), expected.get())) return;
    const std::string target = terrain.horizontal_epsg != 0
                                   ? "EPSG:" + std::to_string(terrain.horizontal_epsg)
                                   : "TERRAIN.prj";
    throw Error("its coordinate system (" + name_of(found.get()) + ") is not the terrain's (" +
                name_of(expected.get()) + "): transform it with \"ogr2ogr -t_srs " + target +
                " OUT.gpkg IN\"");
  });
}

std::vector<std::string> gdal_feature_files(const std::string& path, Indirect indirect) {
  return files_by_gdal(path, [&] { return open(path, indirect); });
}

}  // namespace microtin::importing
