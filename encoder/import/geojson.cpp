// SPDX-License-Identifier: MIT
// Reads JSON, and takes from it what GeoJSON (RFC 7946) says of areas and lines.
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/import/features.hpp"
#include "encoder/import/raster.hpp"
#include "encoder/import/text.hpp"

namespace microtin::importing {
namespace {

constexpr int kDeepestNesting = 32;  // arrays and objects within each other

// A value of JSON. A number keeps its text.
struct Value {
  enum Kind { kNull, kOther, kNumber, kText, kArray, kObject } kind = kNull;
  std::string_view text;      // of a number, or what stands between a text's quotes
  std::vector<Value> values;  // of an array, or of an object in the order of its names
  std::vector<std::string_view> names;
  std::size_t line = 1;

  // Null if there is none.
  const Value* find(std::string_view name) const {
    const auto at = std::find(names.begin(), names.end(), name);
    return at == names.end() ? nullptr : &values[static_cast<std::size_t>(at - names.begin())];
  }

  // A property, whose name may be in capitals, as in a shapefile. Null if there is none.
  const Value* property(std::string_view name) const {
    if (const Value* const exact = find(name)) return exact;
    const auto at = std::find_if(names.begin(), names.end(), [&](std::string_view one) {
      return lower_case(std::string(one)) == name;
    });
    return at == names.end() ? nullptr : &values[static_cast<std::size_t>(at - names.begin())];
  }
};

class JsonReader {
 public:
  JsonReader(const std::string& name, std::string_view text) : name_(name), text_(text) {}

  Value document() {
    Value value = next(0);
    skip_blanks();
    if (at_ != text_.size()) fail();
    return value;
  }

 private:
  [[noreturn]] void fail() const { fail_at(name_, line_, "is not JSON"); }

  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  void skip_blanks() {
    for (; peek() == ' ' || peek() == '\t' || peek() == '\r' || peek() == '\n'; ++at_) {
      if (peek() == '\n') ++line_;
    }
  }

  void expect(char wanted) {
    if (peek() != wanted) fail();
    ++at_;
  }

  Value next(int depth) {
    if (depth > kDeepestNesting) fail_at(name_, line_, "has too many arrays within each other");
    skip_blanks();
    Value value;
    value.line = line_;
    if (peek() == '{') {
      read_object(value, depth);
    } else if (peek() == '[') {
      read_array(value, depth);
    } else if (peek() == '"') {
      value.kind = Value::kText;
      value.text = read_text();
    } else {
      read_word(value);
    }
    return value;
  }

  void read_object(Value& value, int depth) {
    value.kind = Value::kObject;
    for (char end = read_first('}'); end != '}'; end = read_separator('}')) {
      skip_blanks();
      value.names.push_back(read_text());
      skip_blanks();
      expect(':');
      value.values.push_back(next(depth + 1));
    }
  }

  void read_array(Value& value, int depth) {
    value.kind = Value::kArray;
    for (char end = read_first(']'); end != ']'; end = read_separator(']')) {
      value.values.push_back(next(depth + 1));
    }
  }

  // Behind the opening bracket: the closing one, if it follows.
  char read_first(char closing) {
    ++at_;
    skip_blanks();
    if (peek() != closing) return ',';
    ++at_;
    return closing;
  }

  char read_separator(char closing) {
    skip_blanks();
    const char found = peek();
    if (found != ',' && found != closing) fail();
    ++at_;
    return found;
  }

  // Escapes stay as they are: no name that counts has any.
  std::string_view read_text() {
    expect('"');
    const std::size_t start = at_;
    for (; peek() != '"'; ++at_) {
      if (at_ >= text_.size() || peek() == '\n') fail();
      if (peek() == '\\') ++at_;
    }
    return text_.substr(start, at_++ - start);
  }

  void read_word(Value& value) {
    const std::size_t start = at_;
    const std::string_view in_words = "+-.";
    while (std::isalnum(static_cast<unsigned char>(peek())) != 0 ||
           (peek() != '\0' && in_words.find(peek()) != in_words.npos)) {
      ++at_;
    }
    value.text = text_.substr(start, at_ - start);
    if (value.text == "null") return;
    const bool is_word = value.text == "true" || value.text == "false";
    // Properties that do not count may be of any size, and NaN as Python writes it.
    if (!is_word && !number_of_any_size(value.text)) fail();
    value.kind = is_word ? Value::kOther : Value::kNumber;
  }

  const std::string& name_;
  std::string_view text_;
  std::size_t at_ = 0, line_ = 1;
};

class FeatureReader {
 public:
  explicit FeatureReader(const std::string& name) : name_(name) {}

  FeatureFile read(const Value& document) {
    read_any(document);
    FeatureFile file{std::move(features_), {}};
    if (document.kind == Value::kObject) file.stated = system_of(document);
    return file;
  }

 private:
  [[noreturn]] void fail(const Value& value, const std::string& what) const {
    fail_at(name_, value.line, what);
  }

  const std::vector<Value>& array_of(const Value* value, const Value& parent) const {
    if (value == nullptr || value->kind != Value::kArray) fail(parent, "is not GeoJSON");
    return value->values;
  }

  static std::string_view type_of(const Value& value) {
    const Value* const type = value.kind == Value::kObject ? value.find("type") : nullptr;
    return type != nullptr && type->kind == Value::kText ? type->text : std::string_view();
  }

  void read_any(const Value& value) {
    const std::string_view type = type_of(value);
    if (type == "FeatureCollection") {
      for (const Value& one : array_of(value.find("features"), value)) read_any(one);
    } else if (type == "Feature") {
      features_.emplace_back();
      if (const Value* const properties = value.find("properties")) read_properties(*properties);
      const Value* const geometry = value.find("geometry");
      if (geometry != nullptr && geometry->kind != Value::kNull) read_geometry(*geometry);
    } else {
      features_.emplace_back();
      read_geometry(value);
    }
  }

  // Programs write a member `crs`, of an older version of GeoJSON, where the system is another one.
  static StatedSystem system_of(const Value& document) {
    const Value* const crs = document.find("crs");
    const Value* const of_crs =
        crs != nullptr && crs->kind == Value::kObject ? crs->find("properties") : nullptr;
    const Value* const name =
        of_crs != nullptr && of_crs->kind == Value::kObject ? of_crs->find("name") : nullptr;
    if (name == nullptr || name->kind != Value::kText) return {};
    StatedSystem stated;
    stated.name = std::string(name->text);
    stated.horizontal_epsg = code_named(name->text);
    return stated;
  }

  // "EPSG:25832", "urn:ogc:def:crs:EPSG::25832", "urn:ogc:def:crs:OGC:1.3:CRS84"; 0 for others.
  static uint32_t code_named(std::string_view name) {
    constexpr uint32_t kWgs84 = 4326;
    const std::string_view last = name.substr(name.find_last_of(":/") + 1);
    if (last == "CRS84" || last == "CRS84h") return kWgs84;
    uint32_t code = 0;
    const char* const end = last.data() + last.size();
    const auto [next, error] = std::from_chars(last.data(), end, code);
    return next == end && error == std::errc() && name.find("EPSG") != name.npos ? code : 0;
  }

  std::optional<Decimal> number_of(const Value& properties, const char* name,
                                   bool is_negative_allowed) const {
    const Value* const value = properties.property(name);
    if (value == nullptr || value->kind == Value::kNull) return std::nullopt;
    std::optional<Decimal> number;
    if (value->kind == Value::kNumber) number = parse_decimal(value->text);
    if (!number || (number->mantissa < 0 && !is_negative_allowed)) {
      fail(*value,
           std::string(name) + " is not a number" + (is_negative_allowed ? "" : " from 0 up"));
    }
    return number;
  }

  void read_properties(const Value& properties) {
    if (properties.kind != Value::kObject) return;
    features_.back().top = number_of(properties, "top", true);
    features_.back().height = number_of(properties, "height", false);
    features_.back().radius = number_of(properties, "radius", false);
    read_class(properties.property("class"));
    const Value* const bound = properties.property("max_error");
    if (bound == nullptr) return;
    Feature& feature = features_.back();
    feature.has_max_error = true;
    if (bound->kind == Value::kNull) return;
    if (bound->kind == Value::kNumber) feature.max_error = parse_decimal(bound->text);
    if (!feature.max_error || feature.max_error->mantissa < 0) {
      fail(*bound, "max_error is not a number from 0 up, nor null");
    }
  }

  void read_class(const Value* value) {
    if (value == nullptr || (value->kind != Value::kText && value->kind != Value::kNumber)) return;
    features_.back().line_class = std::string(value->text);
    features_.back().place_of_class = name_ + ':' + std::to_string(value->line);
  }

  void read_geometry(const Value& value) {
    const std::string_view type = type_of(value);
    Feature& feature = features_.back();
    const Value* const places = value.kind == Value::kObject ? value.find("coordinates") : nullptr;
    if (type == "Polygon") {
      feature.polygons.push_back(rings_of(places, value));
    } else if (type == "MultiPolygon") {
      for (const Value& one : array_of(places, value)) {
        feature.polygons.push_back(rings_of(&one, value));
      }
    } else if (type == "Point") {
      feature.points.push_back(point_of(value, value.find("coordinates")));
    } else if (type == "MultiPoint") {
      for (const Value& one : array_of(places, value))
        feature.points.push_back(point_of(one, &one));
    } else if (type == "LineString") {
      feature.lines.push_back(line_of(places, value));
    } else if (type == "MultiLineString") {
      for (const Value& one : array_of(places, value))
        feature.lines.push_back(line_of(&one, value));
    } else if (type == "GeometryCollection") {
      for (const Value& one : array_of(value.find("geometries"), value)) read_geometry(one);
    } else {
      fail(value, "is not a polygon, a line or a point of GeoJSON");
    }
  }

  RealRings rings_of(const Value* value, const Value& parent) const {
    RealRings rings;
    for (const Value& ring : array_of(value, parent)) {
      rings.push_back(line_of(&ring, parent));
      if (rings.back().size() < 4) fail(ring, "a ring of a polygon has fewer than four positions");
    }
    return rings;
  }

  RealPoint point_of(const Value& parent, const Value* place) const {
    const std::vector<Value>& numbers = array_of(place, parent);
    if (numbers.size() < 2) fail(parent, "a position has fewer than two numbers");
    RealPoint point{coordinate_of(numbers[0]), coordinate_of(numbers[1])};
    if (numbers.size() > 2) point.z = coordinate_of(numbers[2]);
    return point;
  }

  RealLine line_of(const Value* value, const Value& parent) const {
    RealLine line;
    for (const Value& place : array_of(value, parent)) {
      line.push_back(point_of(parent, &place));
    }
    if (line.size() < 2) fail(parent, "a line has fewer than two positions");
    return line;
  }

  Decimal coordinate_of(const Value& value) const {
    const auto number = value.kind == Value::kNumber ? parse_decimal(value.text, kPlaceDecimals)
                                                     : std::optional<Decimal>();
    if (!number) fail(value, "a coordinate is not a number in range");
    return *number;
  }

  const std::string& name_;
  std::vector<Feature> features_;
};

}  // namespace

FeatureFile import_geojson(const std::string& name, std::string_view text) {
  return FeatureReader(name).read(JsonReader(name, without_mark(text)).document());
}

bool is_geojson(const std::string& path) {
  const std::string suffix = suffix_of(path);
  return suffix == ".geojson" || suffix == ".json";
}

}  // namespace microtin::importing
