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

TEST_CASE("crs: GeoTIFF keys, user-defined codes and values elsewhere do not count") {
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

TEST_CASE("crs: GeoTIFF keys of other units, user-defined ones by their size") {
  const auto keys = [](std::vector<uint16_t> entries, const std::vector<double>& doubles = {}) {
    entries.insert(entries.begin(), {1, 1, 0, 9});
    return reference_of_geo_keys(entries, doubles);
  };
  CHECK(keys({4099, 0, 1, 9001}).vertical_unit == Unit::kMetre);
  CHECK(keys({4099, 0, 1, 9002}).vertical_unit == Unit::kFoot);
  CHECK(keys({4099, 0, 1, 9003}).vertical_unit == Unit::kUsSurveyFoot);
  CHECK(keys({4099, 0, 1, 1033}).vertical_other == "centimetre");
  CHECK(keys({4099, 0, 1, 32767}).vertical_other == "user-defined");
  CHECK(keys({4099, 0, 1, 77}).vertical_other == "EPSG unit 77");
  CHECK(keys({1024, 0, 1, 1, 3076, 0, 1, 9036}).horizontal_other == "kilometre");
  const std::vector<double> sizes = {0, 0.3048006096};
  CHECK(keys({1024, 0, 1, 1, 3076, 0, 1, 32767, 3077, 34736, 1, 1}, sizes).horizontal_unit ==
        Unit::kUsSurveyFoot);
  CHECK(keys({1024, 0, 1, 1, 3076, 0, 1, 32767, 3077, 34736, 1, 2}, sizes).horizontal_unit ==
        Unit::kUnknown);
}

TEST_CASE("crs: codes in a line, of heights too") {
  CHECK(reference_of_line("EPSG:25832").horizontal_epsg == 25832);
  const Reference both = reference_of_line("EPSG:25832+6358");
  CHECK(both.horizontal_epsg == 25832);
  CHECK(both.vertical_epsg == 6358);
  CHECK(both.vertical_unit == Unit::kUsSurveyFoot);
}

TEST_CASE("crs: the vertical axis of a plane has its own unit") {
  const Reference r = reference_of_wkt(
      R"(PROJCRS["p",CS[Cartesian,3],AXIS["E",east,LENGTHUNIT["metre",1]],AXIS["N",north,)"
      R"(LENGTHUNIT["metre",1]],AXIS["h",up,LENGTHUNIT["foot",0.3048]]])");
  CHECK(r.horizontal_unit == Unit::kMetre);
  CHECK(r.vertical_unit == Unit::kFoot);
  CHECK(!r.depths);
}

TEST_CASE("crs: the horizontal part of a text") {
  const std::string plane = R"(PROJCS["a, ] b",UNIT["m",1]])";
  const std::string up = R"(VERT_CS["v",UNIT["m",1]])";
  CHECK(horizontal_part(plane) == plane);
  CHECK(horizontal_part(plane + "," + up) == plane);
  CHECK(horizontal_part("COMPD_CS[\"c, d\", " + plane + "," + up + "]") == plane);
  CHECK(horizontal_part(" COMPOUNDCRS[\"c\",\n" + plane + "," + up + "]") == plane);
  CHECK(horizontal_part("").empty());
  CHECK(horizontal_part("]][") == "]][");
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
