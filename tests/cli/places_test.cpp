// SPDX-License-Identifier: MIT
// Units and coordinate systems, from files and options to files.
#include <doctest/doctest.h>

#include <string>

#include "tests/support/join.hpp"
#include "tests/support/session.hpp"
#include "tests/support/slow.hpp"

using namespace microtin::tests;

namespace {

const char* const kPlacedGrid =
    "ncols 4\nnrows 3\nxllcorner 500000\nyllcorner 5000000\ncellsize 2\n"
    "1 2 3 4\n5 9 7 8\n1 1 3 9\n";

const char* const kDegrees =
    "ncols 4\nnrows 3\nxllcorner 7\nyllcorner 43\ncellsize 0.25\n1 2 3 4\n5 9 7 8\n1 1 3 9\n";

// As ESRI and GDAL write it beside a grid: no codes.
const char* const kZone =
    R"(PROJCS["WGS_1984_UTM_Zone_33N",GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID[)"
    R"("WGS_1984",6378137.0,298.257223563]],PRIMEM["Greenwich",0.0],UNIT["Degree",)"
    R"(0.0174532925199433]],PROJECTION["Transverse_Mercator"],PARAMETER["False_Easting",500000.0],)"
    R"(UNIT["Meter",1.0]])";

const char* const kGeographic =
    R"(GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],)"
    R"(PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]])";

}  // namespace

TEST_CASE("places: a grid's .prj states its system and units, decode writes an equal one") {
  const Session session;
  session.write("t.asc", kPlacedGrid);
  session.write("t.prj", kZone);
  for (const char* const output : {"t.mtin", "t.mtp --tile-vertices 100"}) {
    const Session::Result made = session.run("encode t.asc -o " + std::string(output));
    CHECK(contains(made.out, "units: x and y metre, z metre\n"));
  }
  for (const char* const name : {"t.mtin", "t.mtp"}) {
    const std::string info = session.run("info " + std::string(name)).out;
    CHECK(contains(info, "horizontal_epsg: 32633\n"));
    CHECK(contains(info, "{\"horizontal\": \"metre\", \"vertical\": \"metre\"}"));
  }
  REQUIRE(session.run("decode t.mtin -o back.asc").code == 0);
  CHECK(contains(session.read("back.prj"), "PROJCS[\"WGS_1984_UTM_Zone_33N\",GEOGCS["));
  const Session::Result again = session.run("encode back.asc -o back.mtin");
  CHECK(contains(again.out, "units: x and y metre, z metre\n"));
  CHECK(!contains(again.out, "warning"));
  CHECK(contains(session.run("info back.mtin").out, "horizontal_epsg: 32633\n"));
  // The .prj is an input, too.
  CHECK(session.run("encode t.asc -o t.prj").code == 1);
  CHECK(session.read("t.prj") == kZone);
}

TEST_CASE("places: the suffix of a .prj may be in capitals") {
  for (const char* const name : {"t.PRJ", "t.Prj"}) {
    const Session session;
    session.write("t.asc", kPlacedGrid);
    session.write(name, kZone);
    CHECK(contains(session.run("encode t.asc -o t.mtin").out, "units: x and y metre, z metre\n"));
  }
}

TEST_CASE("places: a .prj that is none is refused, or what is asked for decides") {
  const Session session;
  session.write("t.asc", kPlacedGrid);
  session.write("t.prj", "Projection UTM\nZone 33\n");
  for (const char* const output : {"t.mtin", "t.mtp --tile-vertices 100"}) {
    const std::string encode = "encode t.asc -o " + std::string(output);
    CHECK(contains(session.failure(encode), "t.prj: is not well-known text"));
    CHECK(contains(session.failure(encode + " --units :metre"), "t.prj: is not well-known text"));
    for (const char* const asked : {" --epsg 32633", " --units metre"}) {
      const Session::Result made = session.run(encode + asked);
      CHECK(made.code == 0);
      CHECK(contains(
          made.out,
          "warning: the options override the system of the file, which is not read: t.prj: is no"));
    }
  }
  CHECK(session.run("verify t.mtin t.asc --units metre").code == 0);
}

TEST_CASE("places: heights in other units are converted, in every command that reads a source") {
  const Session session;
  session.write("t.asc", kPlacedGrid);
  session.write("t.prj", std::string(kZone) + R"(,VERTCS["v",UNIT["Centimeter",0.01]])");
  for (const char* const name : {"t.mtin", "t.mtp"}) {
    const std::string tiles = std::string(name) == "t.mtp" ? " --tile-vertices 100" : "";
    const std::string file = name;
    const Session::Result made = session.run(join({"encode t.asc -o ", file, tiles}));
    CHECK(contains(made.out,
                   "units: x and y metre, z metre\nwarning: heights in the unit "
                   "centimetre are converted to metre: times 0.01\n"));
    CHECK(session.run("verify " + file + " t.asc").code == 0);
    CHECK(contains(session.run("verify --json " + file + " t.asc").out,
                   "\"warnings\": [\"heights in the unit centimetre are converted"));
    CHECK(contains(session.run("info " + file).out, "\"highest\": 0.09"));
    CHECK(session.run("render --source t.asc -o t.png " + file).code == 0);
    const Session::Result other =
        session.run(join({"encode t.asc --units :metre --max-error 0.1 -o u", file, tiles}));
    CHECK(contains(other.out, "heights are taken as metre; the file says centimetre\n"));
    CHECK(session.run("verify u" + file + " t.asc").code == 1);
    CHECK(session.run("verify u" + file + " t.asc --units :metre").code == 0);
  }
  REQUIRE(session.run("decode t.mtin -o back.asc").code == 0);
  CHECK(contains(session.read("back.prj"), "UNIT[\"Meter\",1.0]]\n"));
  session.write("t.prj", std::string(kZone) + R"(,VERTCS["v",UNIT["span",0.2286]])");
  CHECK(contains(session.failure("encode t.asc -o v.mtin"),
                 "t.asc: the unit of heights is \"span\", which is not known"));
}

TEST_CASE("places: headers of points state units, options override them with a warning") {
  const Session session;
  session.write("ft.csv", "Easting [m],Northing [m],Height [ft]\n0,0,328\n100,0,330\n0,100,5\n");
  CHECK(contains(session.run("encode ft.csv -o t.mtin").out, "units: x and y metre, z foot\n"));
  CHECK(contains(session.run("encode ft.csv --units metre -o t.mtin").out,
                 "z metre\nwarning: heights are taken as metre; the file says foot\n"));
  session.write("km.csv", "x [km];y [km];z_ft_us\n0;0;328\n0.1;0;330\n0;0.1;5\n");
  CHECK(
      contains(session.run("encode km.csv -o t.mtin").out,
               "units: x and y metre, z US survey foot\nwarning: x and y in the unit kilometre are "
               "converted to metre: times 1000\n"));
  CHECK(contains(session.run("info t.mtin").out, "\"east\": 100.0"));
  session.write("odd.csv", "x,y,z [span]\n0,0,328\n100,0,330\n0,100,5\n");
  CHECK(contains(session.failure("encode odd.csv -o u.mtin"), "\"span\", which is not known"));
  session.write("two.csv", "x [m],y [km],z\n0,0,328\n100,0,330\n0,100,5\n");
  CHECK(contains(session.failure("encode two.csv -o u.mtin"), "x and y are in different units"));
}

TEST_CASE("places: depths are refused, or turned into heights, so that never-below holds upwards") {
  const Session session;
  session.write("t.asc", kPlacedGrid);
  session.write("t.prj", std::string(kZone) +
                             R"(,VERTCS["v",PARAMETER["Direction",-1.0],UNIT["Meter",1.0]])");
  session.write("t.csv", "x,y,depth\n0,0,3\n100,0,4\n0,100,5\n");
  for (const std::string source : {"t.asc", "t.csv --units metre"}) {
    const std::string input = source.substr(0, 5);
    CHECK(contains(session.failure("encode " + source + " -o u.mtin"),
                   input + ": heights are depths by the file's system, which grow downwards: "
                           "negate them with --depths"));
    const Session::Result made = session.run("encode " + source + " --depths -o t.mtin");
    CHECK(contains(made.out, "warning: depths are turned into heights\n"));
    CHECK(contains(session.failure("verify t.mtin " + source), "negate them with --depths"));
    CHECK(session.run("verify t.mtin --depths " + source).code == 0);
  }
  REQUIRE(
      session.run("encode t.asc --depths --max-error 1 --z-step 1 --never-below -o t.mtin").code ==
      0);
  CHECK(contains(session.run("verify t.mtin t.asc --depths").out, "max_below: 0"));
  CHECK(contains(session.run("info t.mtin").out, "\"lowest\": -9"));
  session.write("t.prj", kZone);
  CHECK(contains(session.failure("encode t.asc -o u.mtin --epsg 32633:5715"),
                 "heights are depths (EPSG 5715), which grow downwards"));
  REQUIRE(session.run("encode t.asc -o t.mtin --epsg 32633:5715 --depths").code == 0);
  CHECK(contains(session.run("info t.mtin").out, "vertical_epsg: 5714"));
}

TEST_CASE("places: heights in a file in degrees need a unit") {
  const Session session;
  session.write("t.asc", kDegrees);
  session.write("t.prj", kGeographic);
  for (const char* const output : {"t.mtin", "t.mtp --tile-vertices 100"}) {
    CHECK(contains(session.failure("encode t.asc -o " + std::string(output)),
                   "positions are in degrees, and the unit of heights is not known"));
  }
  CHECK(session.run("encode t.asc -o t.mtin --units :foot").code == 0);
  CHECK(contains(session.run("info t.mtin").out,
                 "{\"horizontal\": \"degree\", \"vertical\": \"foot\"}"));
  CHECK(session.run("encode t.asc -o t.mtin --epsg 4326:5773").code == 0);
  REQUIRE(session.run("decode t.mtin -o back.asc").code == 0);
  REQUIRE(session.run("encode back.asc -o back.mtin").code == 0);  // the .prj knows the heights
  CHECK(contains(session.run("info back.mtin").out, "horizontal_epsg: 4326\nvertical_epsg: 5773"));
}

TEST_CASE("places: codes set units, and may not contradict them") {
  const Session session;
  session.write("t.asc", kPlacedGrid);
  const auto report = [&](const std::string& options) {
    return session.run("encode t.asc -o t.mtin " + options).out;
  };
  CHECK(contains(report("--epsg 32633:6360"), "units: x and y metre, z US survey foot\n"));
  CHECK(contains(report("--units foot"), "units: x and y foot, z foot\n"));
  CHECK(!contains(report("--units foot"), "warning"));
  CHECK(contains(report("--units us-ft:m"), "units: x and y US survey foot, z metre\n"));
  CHECK(contains(report(""),
                 "warning: the unit of x and y is not known: set units or an EPSG code\n"
                 "warning: a .prj next to t.asc can state it\n"));
  CHECK(contains(session.failure("encode t.asc -o u.mtin --epsg 32633 --units foot"),
                 "EPSG 32633 has the unit metre, not foot"));
  CHECK(contains(session.failure("encode t.asc -o u.mtin --epsg 5773"),
                 "EPSG 5773 is a vertical system"));
  CHECK(contains(session.failure("encode t.asc -o u.mtin --epsg 4326:32633"),
                 "EPSG 32633 is a horizontal system"));
  for (const char* const wrong : {"furlong", "m:deg", "m:", "", ":"}) {
    CHECK(
        contains(session.failure("encode t.asc -o u.mtin --units '" + std::string(wrong) + "'", 2),
                 "use a unit, or two with a colon"));
  }
#ifdef MICROTIN_WITH_GDAL
  CHECK(contains(session.failure("encode t.asc -o u.mtin --epsg 999999"),
                 "EPSG has no coordinate reference system 999999"));
  CHECK(contains(report("--epsg 2992"), "units: x and y foot, z foot"));
#else
  CHECK(contains(
      report("--epsg 2992"),
      "warning: EPSG 2992 is not a code known here, and is kept as it is: set its units\nwarning: "
      "the unit of x and y is not known, nor is EPSG 2992 here: set units\n"));
#endif
}

TEST_CASE("places: an option that contradicts the file causes a warning") {
  const Session session;
  session.write("t.asc", kPlacedGrid);
  session.write("t.prj", kZone);
  CHECK(contains(session.run("encode t.asc -o t.mtin --units foot").out,
                 "warning: x and y are taken as foot; the file says metre"));
  CHECK(contains(session.run("encode t.asc -o t.mtin --epsg 32632").out,
                 "warning: EPSG 32632 overrides the file's EPSG 32633\n"));
  CHECK(!contains(session.run("encode t.asc -o t.mtin --epsg 32633").out, "EPSG 32633 is taken"));
}

TEST_CASE("places: scenes and pictures of unknown units warn") {
  const Session session;
  session.write("t.asc", kPlacedGrid);
  REQUIRE(session.run("encode t.asc -o t.mtin").code == 0);
  for (const char* const command : {"decode t.mtin -o t.glb", "render t.mtin -o t.png"}) {
    const Session::Result result = session.run(command);
    CHECK(result.code == 0);
    CHECK(contains(result.err, "warning: t."));
    CHECK(contains(result.err, "units are not known and taken as metres"));
  }
  REQUIRE(session.run("encode t.asc -o t.mtin --units m").code == 0);
  CHECK(session.run("decode t.mtin -o t.glb").err.empty());
  CHECK(session.run("render t.mtin -o t.png").err.empty());
}

TEST_CASE("places: files for autopilots have degrees and metres, or are refused") {
  const Session session;
  session.write("N43E007.hgt", std::string("\0\1\0\2\0\3\0\4\0\5\0\6\0\7\0\10\0\11", 18));
  for (const char* const units : {"degree:foot", "degree:us-foot", "metre:metre", "foot:metre"}) {
    REQUIRE(session.run("encode N43E007.hgt -o t.mtin --units " + std::string(units)).code == 0);
    for (const char* const output : {"N43E007.DAT", "N43E007.TER"}) {
      CHECK(contains(session.failure("decode t.mtin -o " + std::string(output)),
                     "autopilots need positions in degrees and heights in metres; encode the "
                     "terrain in these units"));
    }
  }
}

TEST_CASE("places: meshes name their system, and points of meshes bring it back") {
  const Session session;
  session.write("t.asc", kPlacedGrid);
  REQUIRE(session.run("encode t.asc -o t.mtin --epsg 25832").code == 0);
  REQUIRE(session.run("decode t.mtin -o t.ply").code == 0);
  CHECK(contains(session.read("t.ply"), "\ncomment crs: EPSG:25832\n"));
  REQUIRE(session.run("encode t.ply -o back.mtin").code == 0);
  CHECK(contains(session.run("info back.mtin").out, "horizontal_epsg: 25832\n"));
  session.write("u.asc", kPlacedGrid);
  session.write("u.prj", "LOCAL_CS[\"a site\",\n  UNIT[\"Meter\",1.0]]");
  REQUIRE(session.run("encode u.asc -o u.mtin").code == 0);
  REQUIRE(session.run("decode u.mtin -o u.ply").code == 0);
  CHECK(contains(session.read("u.ply"), "comment crs: LOCAL_CS[\"a site\",   UNIT["));
  CHECK(!contains(session.run("decode u.mtin --lattice -o lattice.ply && cat lattice.ply").out,
                  "comment"));
}

TEST_CASE("places: a grid whose system has no known text causes a warning") {
  const Session session;
  session.write("t.asc", kPlacedGrid);
  REQUIRE(session.run("encode t.asc -o t.mtin --epsg 2056 --units m").code == 0);
  const Session::Result decoded = session.run("decode t.mtin -o back.asc");
  CHECK(decoded.code == 0);
#ifdef MICROTIN_WITH_GDAL
  CHECK(contains(session.read("back.prj"), "CH1903+_LV95"));
#else
  CHECK(contains(decoded.err, "no back.prj is written: the text of EPSG:2056 is not known here"));
#endif
}

TEST_CASE("places: GDAL reads the .prj that is written" * kSlow) {
  const Session session;
  if (session.shell("command -v gdalinfo").out.empty()) {
    MESSAGE("skipped: gdalinfo is not installed");
    return;
  }
  session.write("t.asc", kPlacedGrid);
  const std::vector<std::pair<std::string, std::string>> systems = {
      {"32633", "+proj=utm +zone=33 +datum=WGS84 +units=m"},
      {"32733", "+proj=utm +zone=33 +south +datum=WGS84 +units=m"},
      {"25832", "+proj=utm +zone=32 +ellps=GRS80 +units=m"},
      {"26910", "+proj=utm +zone=10 +datum=NAD83 +units=m"},
      {"3857", "+proj=merc +a=6378137 +b=6378137"}};
  for (const auto& [code, parameters] : systems) {
    REQUIRE(session.run("encode t.asc -o t.mtin --epsg " + code).code == 0);
    REQUIRE(session.run("decode t.mtin -o g.asc").code == 0);
    const std::string found = session.shell("gdalsrsinfo -o proj4 ESRI::g.prj").out;
    CHECK_MESSAGE(contains(found, parameters), found);
  }
}

TEST_CASE("places: info prints extent, size and heights in the terrain's units") {
  const Session session;
  session.write("t.asc",
                "ncols 3\nnrows 3\nxllcenter 100\nyllcenter 50\ncellsize 2\nnodata_value -9\n"
                "-1.5 2 3\n5 6 7\n8 9.5 0\n");
  REQUIRE(session.run("encode t.asc -o t.mtin").code == 0);
  REQUIRE(session.run("encode t.asc --tile-vertices 100 -o t.mtp").code == 0);
  for (const std::string name : {"stream", "pack"}) {
    const std::string info = session.run(name == "pack" ? "info t.mtp" : "info t.mtin").out;
    CHECK(contains(info, "kind: \"" + name + "\"\n"));
    CHECK(contains(info,
                   "extent: {\"west\": 100.0, \"south\": 50.0, \"east\": 104.0, \"north\": 54.0}\n"
                   "size: {\"x\": 4.0, \"y\": 4.0}\n"
                   "heights: {\"lowest\": -1.5, \"highest\": 9.5}\n"));
  }
  CHECK(contains(session.run("info t.mtp --json").out, "\"lowest\": -1.5, \"highest\": 9.5"));
}

TEST_CASE("places: errors name the kind of a file, shard or pack") {
  const Session session;
  REQUIRE(session.run("fractal --size 17 -o t.asc").code == 0);
  REQUIRE(session.run("encode t.asc --tile-vertices 300 --shard 0:0 -o t.shard").code == 0);
  REQUIRE(session.run("encode t.asc --tile-vertices 300 -o t.mtp").code == 0);
  REQUIRE(session.run("encode t.asc -o t.mtin").code == 0);
  for (const char* const command :
       {"info t.shard", "decode t.shard -o o.ply", "verify t.shard t.asc",
        "render t.shard -o o.png", "embed t.shard -o o.h", "height t.shard 1 2"}) {
    CHECK(contains(session.failure(command), "t.shard: is a shard, a part of a pack"));
  }
  CHECK(contains(session.failure("info - < t.mtp"), "-: is a pack"));
  CHECK(contains(session.failure("encode t.mtp -o o.mtin"), "t.mtp: is a pack, which"));
  CHECK(contains(session.failure("encode t.mtin -o o.mtin"), "t.mtin: is a stream, which"));
  CHECK(contains(session.failure("merge t.mtin -o o.mtp"), "not a shard"));
}

TEST_CASE("places: pictures are .png files, with a world file on request" * kSlow) {
  const Session session;
  REQUIRE(session.run("fractal --size 17 -o t.asc").code == 0);
  REQUIRE(session.run("encode t.asc --units m -o t.mtin").code == 0);
  for (const char* const name : {"t.jpg", "t.pdf", "t.tif"}) {
    CHECK(
        contains(session.failure("render t.mtin -o " + std::string(name)),
                 std::string(name) +
                     ": is not a kind of picture that render writes; name it .png, .svg or .html"));
  }
  CHECK(session.run("render t.mtin --no-mesh --palette sea --world-file -o t.png").code == 0);
  const std::string world = session.read("t.pgw");
  CHECK(std::count(world.begin(), world.end(), '\n') == 6);
  CHECK(contains(session.failure("render t.mtin --world-file -o -"),
                 "-: only a .png file gets a world file"));
  CHECK(session.run("render t.mtin --contours auto -o v.png").code == 0);
  CHECK(session.run("render t.mtin --contours 0.5 -o w.png").code == 0);
  CHECK(session.run("render t.mtin --contours 5 -o t.svg").code == 0);
  CHECK(session.read("t.svg").compare(0, 5, "<svg ") == 0);
  CHECK(session.failure("render t.mtin --source t.asc -o u.svg") ==
        "u.svg: a drawing cannot show a map of errors; leave out --source, or write a .png file\n");
  CHECK(session.run("render t.mtin --title Hill --coordinates --north-arrow -o x.png").code == 0);
  CHECK(contains(session.failure("render t.mtin --title a#b -o u.png"), "the title has \"#\""));
  CHECK(session.read("v.png") != session.read("t.png"));
  CHECK(session.read("v.png") != session.read("w.png"));
  CHECK(contains(session.failure("render t.mtin --contours 0 -o u.png", 2),
                 "'0' is not allowed; use auto or a decimal number above 0"));
  CHECK(contains(session.failure("render t.mtin --contours 0.000000001 -o u.png"),
                 "t.mtin: the interval of contours is too small"));
  if (session.run("render t.mtin -o t.html").code == 0) {  // the page was built in
    CHECK(session.shell("microtin render - -o u.html <t.mtin").code == 0);
    const auto terrain_of = [&](const std::string& name) {
      const std::string page = session.read(name), place = "bXRpbg";  // "mtin"
      return page.substr(std::min(page.find(place), page.size()), 100);
    };
    CHECK(terrain_of("t.html").size() == 100);
    CHECK(terrain_of("u.html") == terrain_of("t.html"));
    std::filesystem::remove(session.folder() + "/u.html");
  }
  CHECK(session.failure("render t.mtin --contours auto -o u.html") ==
        "u.html: a page cannot show contours, coordinates, a title or a north arrow; write a .png "
        "or .svg file\n");
  CHECK(contains(session.failure("render t.mtin --palette sky -o u.png", 2),
                 "'sky' is not allowed; use land or sea"));
}

TEST_CASE("places: heights that look like no-data cause a warning in every reader of rasters") {
  const Session session;
  session.write("t.asc",
                "ncols 4\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 2\n"
                "1 2 3 4\n5 -9999 7 8\n1 -9999 3 9\n");
  const std::string told =
      "warning: t.asc: taken as they are: 2 posts of height -9999, far from all others; if they "
      "mark voids, declare it: NODATA_value -9999 in an .asc, ";
  for (const char* const command :
       {"encode t.asc -o t.mtin", "encode t.asc --tile-vertices 100 -o t.mtp",
        "plan t.asc --max-error 1 --tile-vertices 100 --shards 2",
        "encode t.asc --tile-vertices 100 --shard 0:0 -o t.shard"}) {
    const Session::Result result = session.run(command);
    CHECK_MESSAGE(result.code == 0, result.err);
    CHECK_MESSAGE(contains(result.err, told), result.err);
  }
  session.write("t.xyz", "0 0 1\n1 0 2\n0 1 3\n1 1 -9999\n");
  for (const char* const output : {"t.mtin", "t.mtp --tile-vertices 100"}) {
    CHECK(contains(
        session.run("encode t.xyz -o " + std::string(output)).err,
        "1 point of height -9999, far from all others; if they mark voids, leave them out"));
  }
  session.write("u.asc", "NODATA_value -9999\n" + session.read("t.asc"));
  CHECK(session.run("encode u.asc -o u.mtin").err.empty());
}
