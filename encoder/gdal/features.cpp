// SPDX-License-Identifier: MIT
// Writes what GDAL reads of areas, lines and obstacles as GeoJSON, which the library reads.
#include <charconv>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "encoder/gdal/dataset.hpp"

namespace microtin::gdal {
namespace {

[[noreturn]] void refuse(const std::string& why) {
  throw std::runtime_error(why);
}

// The properties that the library reads.
constexpr const char* kFields[] = {"max_error", "top", "height", "radius", "class"};

// The shortest number that is read as this one.
template <class Number>
std::string text_of(Number number) {
  if (!std::isfinite(number)) refuse("a number is infinite or none");
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

std::string in_quotes(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return quoted + '"';
}

std::string value_of(const OGRFeature& feature, int field) {
  if (feature.IsFieldSetAndNotNull(field) == FALSE) return "null";
  const OGRFieldDefn& definition = *feature.GetFieldDefnRef(field);
  if (definition.GetType() == OFTInteger || definition.GetType() == OFTInteger64) {
    return std::to_string(feature.GetFieldAsInteger64(field));
  }
  if (definition.GetType() != OFTReal) {
    return in_quotes(feature.GetFieldAsString(field));
  }
  const double value = feature.GetFieldAsDouble(field);
  return definition.GetSubType() == OFSTFloat32 ? text_of(static_cast<float>(value))
                                                : text_of(value);
}

std::string properties_of(const OGRFeature& feature) {
  std::string text;
  for (const char* const name : kFields) {
    const int field = feature.GetFieldIndex(name);
    if (field < 0) continue;
    text += (text.empty() ? "" : ", ") + in_quotes(name) + ": " + value_of(feature, field);
  }
  return '{' + text + '}';
}

std::string place_of(const OGRPoint& point) {
  const std::string text = '[' + text_of(point.getX()) + ", " + text_of(point.getY());
  return text + (point.Is3D() != FALSE ? ", " + text_of(point.getZ()) : "") + ']';
}

std::string places_of(const OGRSimpleCurve& line) {
  std::string text;
  for (const OGRPoint& point : line) text += (text.empty() ? "" : ", ") + place_of(point);
  return '[' + text + ']';
}

std::string rings_of(OGRPolygon& polygon) {
  polygon.closeRings();
  std::string text;
  for (const OGRLinearRing* const ring : polygon) {
    if (ring->IsEmpty() == FALSE) text += (text.empty() ? "" : ", ") + places_of(*ring);
  }
  return '[' + text + ']';
}

// Adds geometries of GeoJSON, each with a comma before it but the first.
void add(OGRGeometry& geometry, std::string& parts) {
  if (geometry.IsEmpty() != FALSE) return;
  const auto add_part = [&](const char* type, const std::string& places) {
    parts += (parts.empty() ? "{\"type\": \"" : ", {\"type\": \"") + std::string(type) +
             "\", \"coordinates\": " + places + '}';
  };
  const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
  if (type == wkbPoint) {
    add_part("Point", place_of(*geometry.toPoint()));
  } else if (type == wkbLineString) {
    add_part("LineString", places_of(*geometry.toLineString()));
  } else if (type == wkbPolygon) {
    add_part("Polygon", rings_of(*geometry.toPolygon()));
  } else if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection) != FALSE) {
    for (OGRGeometry* const part : *geometry.toGeometryCollection()) add(*part, parts);
  } else {
    refuse(std::string("has a ") + geometry.getGeometryName() +
           ": convert it with \"ogr2ogr -nlt MULTIPOLYGON OUT.gpkg IN\"");
  }
}

// Empty: the feature has no geometry.
std::string line_of(const OGRFeature& feature) {
  const OGRGeometry* const geometry = feature.GetGeometryRef();
  if (geometry == nullptr || geometry->IsEmpty() != FALSE) return "";
  // A copy without curves.
  const std::unique_ptr<OGRGeometry> lines(geometry->getLinearGeometry());
  if (!lines) refuse("has a curve that GDAL cannot convert to lines");
  std::string parts;
  add(*lines, parts);
  return "{\"type\": \"Feature\", \"properties\": " + properties_of(feature) +
         ", \"geometry\": {\"type\": \"GeometryCollection\", \"geometries\": [" + parts + "]}}";
}

std::string features_of(OGRLayer& layer) {
  CPLErrorReset();
  std::string text;
  for (const auto& feature : layer) {
    const std::string one = line_of(*feature);
    if (!one.empty()) text += (text.empty() ? "" : ",\n") + one;
  }
  if (CPLGetLastErrorType() >= CE_Failure) {
    refuse(std::string("cannot be read: ") + CPLGetLastErrorMsg());
  }
  return text;
}

// GeoPackages without a system name one "Undefined geographic SRS", or Cartesian.
bool is_known(const OGRSpatialReference* system) {
  if (system == nullptr || system->IsEmpty()) return false;
  const char* const name = system->GetName();
  return name == nullptr || !STARTS_WITH(name, "Undefined ");
}

void expect_system(const OGRSpatialReference* stated, const OGRSpatialReference* system) {
  if (!is_known(stated) || !is_known(system)) return;
  OGRSpatialReference found(*stated), expected(*system);
  for (OGRSpatialReference* const one : {&found, &expected}) {
    one->StripVertical();
    one->DemoteTo2D(nullptr);
  }
  const char* const options[] = {"IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES",
                                 "IGNORE_COORDINATE_EPOCH=YES", nullptr};
  if (found.IsSame(&expected, options) != FALSE) return;
  refuse("its coordinate system (" + std::string(found.GetName()) + ") is not the terrain's (" +
         expected.GetName() + "): transform it with \"ogr2ogr -t_srs\"");
}

// Whether a layer of GPX has the points of the lines in another one.
bool repeats_another(OGRLayer& layer, GDALDataset& features) {
  if (features.GetDriver() == nullptr || !EQUAL(features.GetDriver()->GetDescription(), "GPX")) {
    return false;
  }
  return EQUAL(layer.GetName(), "route_points") || EQUAL(layer.GetName(), "track_points");
}

}  // namespace

std::string geojson_of(GDALDataset& features, const OGRSpatialReference* system) {
  std::string text, names;
  int count = 0;
  for (int i = 0; i < features.GetLayerCount(); ++i) {
    OGRLayer* const layer = features.GetLayer(i);
    if (layer == nullptr || repeats_another(*layer, features)) continue;
    const std::string found = features_of(*layer);
    if (found.empty()) continue;
    expect_system(layer->GetSpatialRef(), system);
    text = found;
    names += (count++ == 0 ? "" : ", ") + std::string(layer->GetName());
  }
  if (count > 1) {
    refuse("has " + std::to_string(count) + " layers with geometries (" + names +
           "): copy one of them with \"ogr2ogr OUT.gpkg IN LAYER\"");
  }
  return "{\"type\": \"FeatureCollection\", \"features\": [" + text + "]}\n";
}

}  // namespace microtin::gdal
