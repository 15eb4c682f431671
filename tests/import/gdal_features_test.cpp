// SPDX-License-Identifier: MIT
// Polygons, lines and points read by GDAL, in builds with it. GDAL's own program writes the files,
// and GeoJSON of the same features must make the same bytes.
#include <doctest/doctest.h>

#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/session.hpp"

using namespace microtin::tests;

namespace microtin::gdal_features_test {

#ifndef MICROTIN_WITH_GDAL

TEST_CASE("features by others: without GDAL they are refused with a remedy") {
  const Session session;
  session.write("t.asc", "ncols 2\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 1\n1 2\n3 4\n");
  session.write("a.gpkg", "SQLite format 3");
  for (const char* const option :
       {"--area", "--error-map", "--obstacles", "--breaklines", "--route-width 9 --route"}) {
    const std::string words = "encode t.asc --max-error 1 " + std::string(option) + " a.gpkg";
    CHECK(session.failure(words + " -o a.mtin") ==
          "a.gpkg: is not GeoJSON; convert it with \"ogr2ogr OUT.geojson IN\", or build with "
          "-DMICROTIN_WITH_GDAL=ON\n");
  }
}

#else

namespace {

constexpr int kPosts = 65, kCell = 10;

// A rough slope from (0, 0) on.
std::string terrain() {
  std::string text = "ncols 65\nnrows 65\nxllcenter 0\nyllcenter 0\ncellsize 10\n";
  for (int row = kPosts - 1; row >= 0; --row) {
    for (int column = 0; column < kPosts; ++column) {
      text += std::to_string(100 + 2 * column + 3 * row + column * row % 7) + ' ';
    }
    text += '\n';
  }
  return text;
}

std::string feature(const std::string& type, const std::string& places,
                    const std::string& properties) {
  return R"({"type": "Feature", "properties": {)" + properties + R"(}, "geometry": {"type": ")" +
         type + R"(", "coordinates": )" + places + "}}";
}

std::string collection(const std::vector<std::string>& features) {
  std::string text;
  for (const std::string& one : features) text += (text.empty() ? "" : ",\n") + one;
  return R"({"type": "FeatureCollection", "features": [)" + text + "]}";
}

const std::string kEncode = "encode t.asc --epsg 32633 --max-error 9 ";

class Files {
 public:
  Files() { session.write("t.asc", terrain()); }

  // False, with a message, where ogr2ogr is not installed.
  bool are_possible() const {
    if (!session.shell("command -v ogr2ogr").out.empty()) return true;
    MESSAGE("skipped: ogr2ogr is not installed");
    return false;
  }

  // Writes a file by GDAL from one of GeoJSON or of comma-separated texts.
  void convert(const std::string& from, const std::string& to,
               const std::string& options = "-a_srs EPSG:32633") const {
    const Session::Result done =
        session.shell("rm -f '" + to + "' && ogr2ogr '" + to + "' '" + from + "' " + options);
    REQUIRE_MESSAGE(done.code == 0, to << ": " << done.err);
  }

  // Writes geometries by GDAL, each of well-known text with fields.
  void write(const std::string& to, const std::string& fields,
             const std::vector<std::string>& rows) const {
    std::string text = "WKT" + (fields.empty() ? "" : ',' + fields) + '\n';
    for (const std::string& row : rows) text += row + '\n';
    session.write("rows.csv", text);
    convert("rows.csv", to, "-a_srs EPSG:32633 -oo AUTODETECT_TYPE=YES");
  }

  std::string encoded(const std::string& options) const {
    const Session::Result done = session.run(kEncode + options + " -o made.mtin");
    REQUIRE_MESSAGE(done.code == 0, options << ": " << done.err);
    return session.read("made.mtin");
  }

  std::string refused(const std::string& options) const {
    return session.failure(kEncode + options + " -o new.mtin");
  }

  Session session;
};

// Each option with features for it.
std::vector<std::pair<std::string, std::string> > options() {
  const std::string square = "[[[55.5, 40], [480.25, 60], [500, 520], [90, 480], [55.5, 40]]";
  const std::string hole = ", [[200, 200], [300, 200], [300, 300], [200, 200]]]";
  const std::string other = "[[[520, 520], [630, 520], [600, 630], [520, 520]]]";
  return {
      {"--area ",
       collection({feature("MultiPolygon", '[' + square + hole + ", " + other + ']', "")})},
      {"--route-width 90 --route ",
       collection(
           {feature("LineString", "[[30.125, 40], [610, 590]]", ""),
            feature("MultiLineString", "[[[0, 600], [90, 500]], [[300, 0], [300, 50]]]", "")})},
      {"--error-map ", collection({feature("Polygon", square + ']', "\"max_error\": 0.25"),
                                   feature("Polygon", other, "\"max_error\": null")})},
      {"--obstacles ",
       collection(
           {feature("Point", "[203.5, 310]", "\"height\": 80.5, \"radius\": 12"),
            feature("MultiPoint", "[[500, 310], [20, 30]]", "\"top\": 450, \"radius\": 0")})},
      {"--breaklines ",
       collection(
           {feature("LineString", "[[30.5, 40, 119], [300, 330, 259.25], [600, 310, 316]]",
                    "\"class\": \"ridge\""),
            feature("MultiLineString", "[[[100, 600, 302], [300, 500, 312]]]",
                    "\"class\": \"Water\""),
            feature("LineString", "[[500, 100, 231], [500, 250, 275]]", "\"class\": null")})},
  };
}

// What layers of one type of geometry need, as all formats but GeoPackages have.
std::string layer_for(const std::string& option, const std::string& name) {
  const std::string type = option == "--obstacles "    ? "MULTIPOINT"
                           : option == "--breaklines " ? "MULTILINESTRINGZ"
                                                       : "PROMOTE_TO_MULTI";
  if (name == "f.fgb") return " -lco SPATIAL_INDEX=NO -nlt " + type;
  return name == "f.shp" && option == "--obstacles " ? " -nlt " + type : "";
}

}  // namespace

TEST_CASE("gdal features: each option makes the bytes that GeoJSON makes") {
  const Files files;
  if (!files.are_possible()) return;
  for (const auto& both : options()) {
    const std::string option = both.first;
    files.session.write("f.geojson", both.second);
    const std::string expected = files.encoded(option + "f.geojson");
    CHECK(expected != files.encoded(""));
    for (const std::string name : {"f.gpkg", "f.shp", "f.fgb"}) {
      files.convert("f.geojson", name, "-a_srs EPSG:32633" + layer_for(option, name));
      CHECK_MESSAGE(files.encoded(option + name) == expected, option << name);
    }
  }
}

TEST_CASE("gdal features: verify, update, plan and packs read them, too") {
  const Files files;
  if (!files.are_possible()) return;
  const Session& session = files.session;
  session.write("l.geojson", options().back().second);
  files.convert("l.geojson", "l.gpkg");
  const std::string terrain = " t.asc --epsg 32633 --breaklines l.";
  for (const std::string name : {"geojson", "gpkg"}) {
    const std::string source = terrain + name, pack = name + ".mtp", other = "u" + pack;
    const auto expect = [&](std::string command, const std::string& rest) {
      const auto done = session.run(command.append(source).append(rest));
      CHECK_MESSAGE(done.code == 0, done.err);
    };
    expect("encode", " --max-error 9 --tile-size 16 -o " + pack);
    expect("verify " + pack, "");
    expect("update " + pack, " --bound-at points -o " + other);
    expect("plan", " --max-error 9 --shards 2");
    CHECK(session.read(other) == session.read("geojson.mtp"));
  }
  CHECK(session.read("gpkg.mtp") == session.read("geojson.mtp"));
}

TEST_CASE("gdal features: curves become lines, and empty parts and rows are left out") {
  const Files files;
  if (!files.are_possible()) return;
  const std::vector<std::string> rows = {
      "\"CIRCULARSTRING Z (100 300 245, 200 400 271, 300 300 275)\",ridge",
      "\"LINESTRING EMPTY\",wall",
      "\"\",wall",
      "\"GEOMETRYCOLLECTION (POINT EMPTY, MULTILINESTRING ((400 100, 400 300), EMPTY))\",",
      R"row("CURVEPOLYGON (COMPOUNDCURVE ((50 50, 50 95), (50 95, 95 50, 50 50)))",dam)row",
  };
  files.write("c.gpkg", "class", rows);
  const Session::Result made =
      files.session.run("encode t.asc --epsg 32633 --max-error 20 --breaklines c.gpkg -o c.mtin");
  CHECK_MESSAGE(made.code == 0, made.err);
  CHECK(contains(made.out, "breaklines: 3 lines"));
  const std::string info = files.session.run("info --json c.mtin").out;
  CHECK_MESSAGE(contains(info, "\"ridge\""), info);
  CHECK(contains(info, "\"dam\""));
  CHECK(!contains(info, "\"wall\""));
}

TEST_CASE("gdal features: measures and whole numbers are read, and names in capitals") {
  const Files files;
  if (!files.are_possible()) return;
  files.session.write("o.geojson", collection({feature("Point", "[203, 310]", "\"height\": 80")}));
  files.write("o.gpkg", "HEIGHT", {"\"POINT M (203 310 7)\",80"});
  CHECK(files.encoded("--obstacles o.gpkg") == files.encoded("--obstacles o.geojson"));
}

TEST_CASE("gdal features: another coordinate system is refused, and none is the terrain's") {
  const Files files;
  if (!files.are_possible()) return;
  files.session.write("f.geojson", options()[0].second);
  const std::string expected = files.encoded("--area f.geojson");
  files.convert("f.geojson", "none.shp", "");
  std::filesystem::remove(files.session.folder() + "/none.prj");  // GeoJSON is in degrees for GDAL
  CHECK(files.encoded("--area none.shp") == expected);
  files.convert("none.shp", "undefined.gpkg", "");
  CHECK(files.encoded("--area undefined.gpkg") == expected);
  files.convert("f.geojson", "heights.gpkg", "-a_srs EPSG:32633+5773");
  CHECK(files.encoded("--area heights.gpkg") == expected);
  files.convert("f.geojson", "other.gpkg", "-a_srs EPSG:25832");
  CHECK(files.refused("--area other.gpkg") ==
        "other.gpkg: its coordinate system (ETRS89 / UTM zone 32N, EPSG:25832) is not the "
        "terrain's (WGS 84 / UTM zone 33N, EPSG:32633): transform it with \"ogr2ogr -t_srs "
        "EPSG:32633 OUT.gpkg IN\"\n");
  const std::string words = "its coordinate system (ETRS89 / UTM zone 32N, EPSG:25832) is not";
  files.convert("f.geojson", "other.shp", "-a_srs EPSG:25832");
  for (const char* const option :
       {"--error-map ", "--obstacles ", "--breaklines ", "--route-width 90 --route "}) {
    CHECK(contains(files.refused(option + std::string("other.shp")), words));
  }
  // The codes of the terrain may come from the command line alone.
  const std::string area = " --units metre --max-error 9 --area other.gpkg -o t.mtin";
  CHECK(files.session.run("encode t.asc" + area).code == 0);
}

TEST_CASE("gdal features: what cannot be read is refused with its place and a remedy") {
  const Files files;
  if (!files.are_possible()) return;
  const auto error = [&](const std::string& option, const std::string& fields,
                         const std::vector<std::string>& rows) {
    files.write("f.gpkg", fields, rows);
    return files.refused(option + " f.gpkg");
  };
  CHECK(error("--area", "a", {"\"LINESTRING (0 0, 9 9)\",1"}) ==
        "f.gpkg: has no polygon; draw one around the area\n");
  CHECK(error("--breaklines", "class",
              {"\"LINESTRING (0 0, 9 9)\",wall", "\"LINESTRING (0 0, 9 9)\",wal"})
            .find("f.gpkg: feature 2: 'wal' is not a class of lines; use one of ") == 0);
  CHECK(error("--breaklines", "a", {"\"LINESTRING (0 0)\",1"}) ==
        "f.gpkg: feature 1: a line has fewer than two positions\n");
  CHECK(error("--breaklines", "a", {"\"LINESTRING (0 0, 1e300 9)\",1"}) ==
        "f.gpkg: feature 1: a coordinate is not a number, or out of range\n");
  CHECK(error("--area", "a", {"\"TIN (((0 0, 9 0, 9 9, 0 0)))\",1"}) ==
        "f.gpkg: feature 1: is a TIN: convert it with \"ogr2ogr -nlt MULTIPOLYGON OUT.gpkg IN\"\n");
  CHECK(error("--obstacles", "height,radius", {"\"POINT (9 9)\",-1,2"}) ==
        "f.gpkg: feature 1: height is not a number from 0 up\n");
  CHECK(error("--obstacles", "top", {"\"POINT (9 9)\",tall"}) ==
        "f.gpkg: feature 1: top is not a number\n");
  CHECK(contains(error("--obstacles", "radius", {"\"POINT (9 9)\",3"}),
                 "f.gpkg: an obstacle needs either a top"));
  files.session.write("nonsense.gpkg", "nonsense");
  const std::string unknown = files.refused("--area nonsense.gpkg");
  CHECK_MESSAGE(contains(unknown, "nonsense.gpkg: GDAL cannot open it: not recognized as "),
                unknown);
  CHECK(contains(unknown, "convert other formats with \"ogr2ogr OUT.gpkg IN\"\n"));
  CHECK(files.refused("--breaklines nosuch.shp") ==
        "nosuch.shp: GDAL cannot open it: No such file or directory\n");
}

TEST_CASE("gdal features: one of several layers is asked for") {
  const Files files;
  if (!files.are_possible()) return;
  files.session.write("f.geojson", options()[1].second);
  files.convert("f.geojson", "two.gpkg", "-a_srs EPSG:32633 -nln roads");
  const auto add = [&](const std::string& more) {
    REQUIRE(files.session.shell("ogr2ogr -update two.gpkg f.geojson " + more).code == 0);
  };
  const std::string option = "--route-width 90 --route ";
  add("-a_srs EPSG:4326 -nln empty -where \"FID < 0\"");  // which is not counted
  CHECK(files.encoded(option + "two.gpkg") == files.encoded(option + "f.geojson"));
  add("-a_srs EPSG:32633 -nln rivers");
  CHECK(files.refused(option + "two.gpkg") ==
        "two.gpkg: has 2 layers with geometries (roads, rivers): copy one of them with \"ogr2ogr "
        "OUT.gpkg IN LAYER\"\n");
}

TEST_CASE("gdal features: a route comes from a navigator's GPX, in degrees") {
  const Files files;
  if (!files.are_possible()) return;
  std::string degrees = terrain();
  const size_t cell = degrees.find("cellsize");
  degrees.replace(cell, degrees.find('\n', cell) - cell, "cellsize 0.001");
  files.session.write("d.asc", degrees);
  const std::string points =
      "<trkpt lon=\"0.0105\" lat=\"0.01\"><ele>150</ele></trkpt>"
      "<trkpt lon=\"0.05\" lat=\"0.0425\"><ele>160</ele></trkpt>";
  files.session.write("r.gpx", "<gpx version=\"1.1\" creator=\"t\"><trk><trkseg>" + points +
                                   "</trkseg></trk></gpx>");
  files.session.write("r.geojson",
                      collection({feature("LineString", "[[0.0105, 0.01], [0.05, 0.0425]]", "")}));
  const std::string encode =
      "encode d.asc --epsg 4326:5773 --max-error 9 --route-width 900 --route ";
  for (const char* const name : {"gpx", "geojson"}) {
    const auto made = files.session.run(encode + "r." + name + " -o " + name + ".mtin");
    CHECK_MESSAGE(made.code == 0, made.err);
  }
  CHECK(files.session.read("gpx.mtin") == files.session.read("geojson.mtin"));
}

TEST_CASE("gdal features: files that name others are read only when allowed") {
  const Files files;
  if (!files.are_possible()) return;
  files.session.write("f.geojson", options()[0].second);
  files.convert("f.geojson", "f.gpkg");
  files.session.write("f.vrt",
                      "<OGRVRTDataSource><OGRVRTLayer name=\"f\"><SrcDataSource>f.gpkg"
                      "</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>");
  CHECK(files.refused("--area f.vrt") ==
        "f.vrt: names other files, which are read only with --allow-vrt\n");
  CHECK(files.encoded("--allow-vrt --area f.vrt") == files.encoded("--area f.geojson"));
  CHECK(contains(files.refused("--area /vsizip/f.zip/f.shp"),
                 ": is a virtual file of GDAL's, which is read only with --allow-vrt"));
  CHECK(contains(files.refused("--area http://localhost/f.gpkg"), "GDAL cannot open it"));
}

TEST_CASE("gdal features: no file that one is read from is written over") {
  const Files files;
  if (!files.are_possible()) return;
  files.session.write("f.geojson", options()[4].second);
  files.convert("f.geojson", "f.shp");
  const std::string before = files.session.read("f.dbf");
  const Session::Result over = files.session.run(kEncode + "--breaklines f.shp -o f.dbf");
  CHECK(over.err == "microtin: f.dbf: is also an input; choose another output\n");
  CHECK(files.session.read("f.dbf") == before);
}

TEST_CASE("gdal features: damaged files are read or refused, and never crash the program") {
  const Files files;
  if (!files.are_possible()) return;
  files.session.write("f.geojson", options()[4].second);
  std::mt19937 chance(42);
  int refused = 0;
  for (const std::string name : {"f.gpkg", "f.shp", "f.dbf", "f.fgb"}) {
    const std::string option = "--breaklines " + (name == "f.dbf" ? std::string("f.shp") : name);
    files.convert(
        "f.geojson", name == "f.dbf" ? "f.shp" : name,
        name == "f.fgb" ? "-nlt PROMOTE_TO_MULTI -a_srs EPSG:32633" : "-a_srs EPSG:32633");
    const std::string whole = files.session.read(name);
    for (int round = 0; round < 12; ++round) {
      std::string damaged = whole;
      if (round % 4 == 0) damaged.resize(chance() % whole.size());
      for (int i = 0; i < 3 && !damaged.empty(); ++i) {
        // The content of a GeoPackage is a small part of it.
        const size_t first = name == "f.gpkg" && round % 2 != 0 ? damaged.size() * 3 / 4 : 0;
        damaged[first + chance() % (damaged.size() - first)] = static_cast<char>(chance() % 256);
      }
      files.session.write(name, damaged);
      const Session::Result done = files.session.run(kEncode + option + " -o made.mtin");
      CHECK_MESSAGE((done.code == 0 || done.code == 1), name << ' ' << round << ": " << done.err);
      refused += done.code;
    }
    files.session.write(name, whole);
  }
  CHECK(refused > 9);
}

#endif

}  // namespace microtin::gdal_features_test
