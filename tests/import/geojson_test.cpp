// SPDX-License-Identifier: MIT
// GeoJSON, valid and broken in every way; rings against a place-by-place check.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/import/features.hpp"
#include "encoder/terrain/polygons.hpp"
#include "tests/support/layers.hpp"

using namespace microtin;
using namespace microtin::tests;
using namespace microtin::importing;

namespace {

const std::string kSquare = R"({"type": "Polygon", "coordinates": [[[0,0],[4,0],[4,4],[0,0]]]})";

std::string feature(const std::string& geometry, const std::string& properties) {
  return R"({"type":"Feature","geometry":)" + geometry + R"(,"properties":)" + properties + "}";
}

std::string message_of(const std::string& text) {
  try {
    import_geojson("a.geojson", text);
  } catch (const base::Error& error) {
    return error.text();
  }
  return "";
}

}  // namespace

TEST_CASE("geojson: collections, features and geometries give their polygons and lines") {
  const auto all =
      import_geojson(
          "a", R"({"type":"FeatureCollection","name":"\u00e9 \"x\"","features":[)" +
                   feature(kSquare, R"({"max_error":2.5,"more":[true,{"a":null}]})") + "," +
                   feature(R"({"type":"GeometryCollection","geometries":[{"type":"MultiLineString",
                          "coordinates":[[[1,2,9],[3e0,-4.25]],[[0,0],[1,1]]]},)" +
                               kSquare + "]}",
                           "{\"max_error\":null}") +
                   "," + feature("null", "null") + "]}")
          .features;
  REQUIRE(all.size() == 3);
  CHECK(all[0].polygons.size() == 1);
  CHECK(to_string(*all[0].max_error) == "2.5");
  CHECK(all[1].lines.size() == 2);
  CHECK(all[1].polygons.size() == 1);
  CHECK(to_string(all[1].lines[0][1].y) == "-4.25");
  CHECK(all[1].has_max_error);
  CHECK(!all[1].max_error);
  CHECK(!all[2].has_max_error);
  CHECK(import_geojson("a", kSquare).features[0].polygons[0][0].size() == 4);
}

TEST_CASE("geojson: what is none is refused with its line") {
  CHECK(message_of("{\n\"type\": \"Polygon\",\n\"coordinates\": [[[0,0],[4,0],[0,0]]]}") ==
        "a.geojson:3: a ring of a polygon has fewer than four positions");
  const std::vector<std::string> broken = {"",
                                           "[",
                                           "{\"type\"}",
                                           kSquare + "x",
                                           "nul",
                                           "\"open",
                                           R"({"type":"Point","coordinates":[1]})",
                                           R"({"type":"Polygon"})",
                                           R"({"type":"Polygon","coordinates":[[1,2]]})",
                                           std::string(99, '['),
                                           R"({"type":"LineString","coordinates":[[1,2]]})",
                                           R"({"type":"LineString","coordinates":[[1],[2]]})",
                                           R"({"type":"LineString","coordinates":[["1",2],[3,4]]})",
                                           "{\"a\":1e999}",
                                           R"({"type":"FeatureCollection"})",
                                           feature(kSquare, "{\"max_error\":-1}"),
                                           feature(kSquare, "{\"max_error\":\"2\"}")};
  for (const std::string& text : broken) CHECK_MESSAGE(message_of(text) != "", text);
  for (std::size_t size = 0; size < kSquare.size(); ++size) {
    CHECK(message_of(kSquare.substr(0, size)) != "");
  }
}

TEST_CASE("geojson: a byte order mark, names in capitals and other programs' properties are read") {
  const FeatureFile file =
      import_geojson("a", "\xEF\xBB\xBF" + feature(R"({"type":"Point","coordinates":[1,2]})",
                                                   R"({"AREA":1e300,"id":12345678901234567890123,
                                                       "share":NaN,"least":-Infinity,
                                                       "Radius":7,"HEIGHT":3,"height":2})"));
  REQUIRE(file.features.size() == 1);
  REQUIRE(file.features[0].radius);
  CHECK(to_string(*file.features[0].radius) == "7");
  CHECK(to_string(*file.features[0].height) == "2");
  for (const char* const number : {"1e300", "NaN", "12345678901234567890123"}) {
    const std::string point = std::string("[") + number + ",2]";
    CHECK(message_of(R"({"type":"Point","coordinates":)" + point + "}") ==
          "a.geojson:1: a coordinate is not a number in range");
    CHECK(message_of(feature(kSquare, std::string("{\"MAX_ERROR\":") + number + "}")) ==
          "a.geojson:1: max_error is not a number from 0 up, nor null");
  }
}

TEST_CASE("geojson: the member crs states the system") {
  const auto code_of = [](const std::string& crs) {
    return import_geojson("a", R"({"type":"FeatureCollection","features":[],"crs":)" + crs + "}")
        .stated.horizontal_epsg;
  };
  const auto named = [&](const std::string& name) {
    return code_of(R"({"type":"name","properties":{"name":")" + name + "\"}}");
  };
  CHECK(named("urn:ogc:def:crs:EPSG::25832") == 25832);
  CHECK(named("urn:ogc:def:crs:EPSG:9.1:2056") == 2056);
  CHECK(named("EPSG:3857") == 3857);
  CHECK(named("http://www.opengis.net/def/crs/EPSG/0/4326") == 4326);
  CHECK(named("urn:ogc:def:crs:OGC:1.3:CRS84") == 4326);
  for (const char* const other : {"IGNF:25832", "EPSG:", "EPSG:x", "EPSG:99999999999", ""}) {
    CHECK_MESSAGE(named(other) == 0, other);
  }
  for (const char* const other :
       {"null", "5", "{}", R"({"properties":5})", R"({"properties":{"name":5}})"}) {
    CHECK_MESSAGE(code_of(other) == 0, other);
  }
}

TEST_CASE("geojson: rings hold the posts within them and on their border, and no others") {
  uint32_t random = 7;
  const auto next = [&] {
    return static_cast<int64_t>((random = random * 1664525u + 1013904223u) >> 16) % 33;
  };
  for (int round = 0; round < 200; ++round) {
    std::vector<std::pair<int64_t, int64_t>> ring;  // in halves of a post
    ring.resize(static_cast<size_t>(3 + round % 5));
    for (auto& [x, y] : ring) {
      x = next();
      y = next();
    }
    terrain::RealRings rings(1);
    for (const auto& [x, y] : ring)
      rings[0].push_back({exact::make_decimal(5 * x, 1), exact::make_decimal(5 * y, 1)});
    const terrain::Rings made(rings, {0, 1, 1}, {0, 1, 1});
    for (int64_t y = -1; y < 18; ++y) {
      for (int64_t x = -1; x < 18; ++x) {
        bool inside = false, on_border = false;
        for (std::size_t i = 0; i < ring.size(); ++i) {
          const auto [ax, ay] = ring[i];
          const auto [bx, by] = ring[(i + 1) % ring.size()];
          const int64_t px = 2 * x, py = 2 * y,
                        cross = (bx - ax) * (py - ay) - (by - ay) * (px - ax);
          const bool within = std::min(ax, bx) <= px && px <= std::max(ax, bx) &&
                              std::min(ay, by) <= py && py <= std::max(ay, by);
          on_border = on_border || (cross == 0 && within);
          if ((ay > py) != (by > py) && (cross > 0) == (by > ay)) inside = !inside;
        }
        CHECK(made.contains(x, y) == (inside || on_border));
      }
    }
  }
}
