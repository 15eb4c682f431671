// SPDX-License-Identifier: MIT
// Coordinate reference systems as files state them.
#include "encoder/import/crs.hpp"

#include <doctest/doctest.h>

#include <string>

#include "tests/support/layers.hpp"

using namespace microtin::tests;

TEST_CASE("crs: well-known text of version 1, compound") {
  const Reference r = reference_of_wkt(
      R"(COMPD_CS["a, [b]",PROJCS["UTM",GEOGCS["WGS 84",DATUM["W",AUTHORITY["EPSG","6326"]],
      UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG","4326"]],
      PROJECTION["Transverse_Mercator"],PARAMETER["k",0.9996],UNIT["metre",1,
      AUTHORITY["EPSG","9001"]],AXIS["Easting",EAST],AUTHORITY["EPSG","32633"]],VERT_CS["h",
      VERT_DATUM["d",2005],UNIT["foot",0.3048],AUTHORITY["EPSG","5773"]],AUTHORITY["EPSG","9999"]])");
  CHECK(r.horizontal_epsg == 32633);
  CHECK(r.vertical_epsg == 5773);
  CHECK(r.horizontal_unit == Unit::kMetre);
  CHECK(r.vertical_unit == Unit::kFoot);
}

TEST_CASE("crs: well-known text of version 2") {
  const Reference r = reference_of_wkt(
      R"(PROJCRS["NAD83",BASEGEOGCRS["N",DATUM["d",ELLIPSOID["e",6378137,298.25,LENGTHUNIT["metre",1]]],
      ID["EPSG",4269]],CONVERSION["c",PARAMETER["p",1,LENGTHUNIT["metre",1]]],CS[Cartesian,2],
      AXIS["easting",east,ORDER[1],LENGTHUNIT["US survey foot",0.304800609601219]],ID["EPSG",2992]])");
  CHECK(r.horizontal_epsg == 2992);
  CHECK(r.horizontal_unit == Unit::kUsSurveyFoot);
  CHECK(r.vertical_unit == Unit::kUnknown);
  const Reference degrees = reference_of_wkt(
      R"(GEOGCRS["WGS 84",CS[ellipsoidal,2],ANGLEUNIT["degree",0.0174532925199433],ID["EPSG",4326]])");
  CHECK(degrees.horizontal_epsg == 4326);
  CHECK(degrees.horizontal_unit == Unit::kDegree);
}

TEST_CASE("crs: a system without a code is kept as its text, up to a NUL") {
  const std::string site = "PROJCS[\"site\",UNIT[\"metre\",1]]";
  CHECK(reference_of_wkt(site).wkt == site);
  CHECK(reference_of_wkt(site + std::string(3, '\0')).wkt == site);
  CHECK(reference_of_wkt("PROJCS[\"x\",AUTHORITY[\"EPSG\",\"25832\"]]").wkt.empty());
  CHECK(reference_of_wkt(std::string(kLongestWkt, ' ')).wkt.size() == kLongestWkt);
  CHECK(reference_of_wkt(std::string(kLongestWkt + 1, ' ')).wkt.empty());
}

TEST_CASE("crs: what is not understood stays unknown") {
  for (const char* text :
       {"", "]]][[[", "PROJCS[", "PROJCS[\"x\",UNIT[\"chain\",20.1168],AUTHORITY[\"ESRI\",\"1\"]]",
        "PROJCS[\"x\",AUTHORITY[\"EPSG\",\"12x\"]]", "UNIT[\"metre\",1]",
        "GEOGCS[\"x\",UNIT[\"grad\",0.0157]]", "PROJCS[\"x\",UNIT[\"metre\"]]", "\"PROJCS["}) {
    const Reference r = reference_of_wkt(text);
    CHECK_MESSAGE(r.horizontal_epsg == 0, text);
    CHECK_MESSAGE(r.horizontal_unit == Unit::kUnknown, text);
  }
}

TEST_CASE("crs: brackets deeper than any system has end the reading, so that it is linear") {
  const auto system_within = [](int depth) {
    std::string text;
    for (int i = 0; i < depth; ++i) text += "X[";
    return reference_of_wkt(text + "GEOGCS[\"x\",AUTHORITY[\"EPSG\",\"4326\"]]");
  };
  CHECK(system_within(20).horizontal_epsg == 4326);
  CHECK(system_within(200).horizontal_epsg == 0);
}

TEST_CASE("crs: GeoTIFF keys; user-defined codes and values elsewhere do not count") {
  const auto keys = [](std::vector<uint16_t> entries) {
    entries.insert(entries.begin(), {1, 1, 0, 9});
    return reference_of_geo_keys(entries);
  };
  CHECK(keys({1024, 0, 1, 1, 3072, 0, 1, 32767, 3076, 0, 1, 9003}).horizontal_epsg == 0);
  CHECK(keys({1024, 0, 1, 1, 3076, 0, 1, 9003}).horizontal_unit == Unit::kUsSurveyFoot);
  CHECK(keys({3072, 34736, 1, 25832}).horizontal_epsg == 0);
  CHECK(keys({1024, 0, 1, 2, 2048, 0, 1, 4258, 4099, 0, 1}).horizontal_unit == Unit::kDegree);
  CHECK(reference_of_geo_keys({}).horizontal_unit == Unit::kUnknown);
}

TEST_CASE("crs: codes of files set units that are not stated, as far as they are known") {
  const Reference r =
      reference_of_geo_keys({1, 1, 0, 3, 1024, 0, 1, 1, 3072, 0, 1, 2263, 4096, 0, 1, 6360});
  CHECK(r.horizontal_epsg == 2263);
  CHECK(r.vertical_unit == Unit::kUsSurveyFoot);
#ifdef MICROTIN_WITH_GDAL
  CHECK(r.horizontal_unit == Unit::kUsSurveyFoot);
#else
  CHECK(r.horizontal_unit == Unit::kUnknown);
#endif
  // 5103 is a datum, which old files name instead of its heights.
  const Reference datum = reference_of_geo_keys({1, 1, 0, 1, 4096, 0, 1, 5103});
  CHECK(datum.vertical_epsg == 5103);
  CHECK(datum.vertical_unit == Unit::kUnknown);
}
