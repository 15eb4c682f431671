// SPDX-License-Identifier: MIT
// One terrain from several files.
#include "encoder/import/mosaic.hpp"

#include <doctest/doctest.h>

#include <array>
#include <ctime>
#include <string>

#include "microtin/surface.hpp"
#include "tests/support/join.hpp"
#include "tests/support/laz_file.hpp"
#include "tests/support/session.hpp"
#include "tests/support/slow.hpp"

using namespace microtin::tests;
namespace fs = std::filesystem;

namespace {

std::string grid(int x, int y, const std::string& heights, const std::string& size = "2") {
  return "ncols 3\nnrows 2\nxllcenter " + std::to_string(x) + "\nyllcenter " + std::to_string(y) +
         "\ncellsize " + size + "\nnodata_value -9\n" + heights + "\n";
}

// An SRTM cell of 3 x 3 posts, in big-endian metres.
std::string cell(const std::string& heights) {
  std::string bytes;
  for (const char height : heights) bytes += std::string(1, '\0') + height;
  return bytes;
}

// Four points of LAS 1.2, of classes 2 and 5.
std::string scan() {
  std::string las(227, '\0');
  las.replace(0, 4, "LASF");
  las[24] = 1;
  las[25] = 2;
  las[94] = las[96] = '\xE3';
  las[105] = 20;
  las[107] = 4;
  for (const size_t axis : {0u, 1u, 2u}) {
    las.replace(131 + 8 * axis, 8, std::string("\0\0\0\0\0\0\xF0\x3F", 8));  // a scale of 1
  }
  using Return = std::array<char, 4>;  // x, y, z, class
  for (const auto& [x, y, z, code] :
       {Return{0, 0, 1, 2}, Return{9, 0, 1, 2}, Return{0, 9, 1, 2}, Return{4, 4, 9, 5}}) {
    std::string point(20, '\0');
    point[0] = x;
    point[4] = y;
    point[8] = z;
    point[15] = code;
    las += point;
  }
  return las;
}

}  // namespace

TEST_CASE("mosaic: cells beyond 180 degrees continue their neighbours' longitudes" * kSlow) {
  const Session session;
  fs::create_directory(session.folder() + "/cells");
  session.write("cells/N00E179.hgt", cell("\1\2\3\4\5\6\7\10\11"));
  session.write("cells/N00W180.hgt", cell("\3\2\1\6\5\4\11\10\7"));
  const char* const sources[] = {"cells", "cells/N00E179.hgt cells/N00W180.hgt",
                                 "cells/N00W180.hgt cells/N00E179.hgt"};
  for (const std::string source : sources) {
    for (const std::string file : {"both.mtin", "both.mtp"}) {
      const Session::Result made =
          session.run(join({"encode ", source, " --max-error 0 -o ", file}));
      REQUIRE(made.code == 0);
      CHECK(contains(made.out + made.err,
                     "1 lies beyond 180 degrees east and continues its neighbours' longitudes, to "
                     "181"));
      CHECK(session.run(join({"verify ", file, " ", source})).code == 0);
      for (const std::string by : {"", " --device"}) {
        const std::string ask = join({"height ", file, by, " -- "});
        CHECK(session.run(ask + "179.5 0").out == "8\n");
        CHECK(session.run(ask + "180.5 0.5").out == "5\n");
        CHECK(session.run(ask + "-179.5 0.5").out == "5\n");
        CHECK(session.run(ask + "-180 1").out == "3\n");
        CHECK(session.run(ask + "180 1").out == "3\n");
        CHECK(session.run(ask + "-178.9 0.5").out == "outside\n");
        CHECK(session.run(ask + "0.5 0.5").out == "outside\n");
      }
      const auto surface = microtin::encoder::Surface::from_file(session.folder() + "/" + file);
      CHECK(surface.info().box.west == 179);
      CHECK(surface.info().box.east == 181);
      const double x[] = {-179.5, 180.5, -180, 181, -179}, y[] = {0.5, 0.5, 1, 0, 0};
      double heights[5];
      surface.heights(5, x, y, heights);
      CHECK(heights[0] == 5);
      CHECK(heights[1] == 5);
      CHECK(heights[2] == 3);
      CHECK(heights[3] == 7);
      CHECK(heights[4] == 7);
      REQUIRE(session.run("decode " + file + " --like cells/N00W180.hgt -o west.asc").code == 0);
      CHECK(contains(session.read("west.asc"), "xllcenter -180\n"));
      CHECK(contains(session.read("west.asc"), "3 2 1\n6 5 4\n9 8 7\n"));
      CHECK(session.run("decode " + file + " -o N00W180.DAT").code == 0);
      CHECK(session.run("decode " + file + " -o N00E179.DAT").code == 0);
      CHECK(session.run("decode " + file + " -o N00E177.DAT").code == 1);
    }
  }
  session.write("east.csv", "lon,lat,z\n179.5,0,1\n179.9,1,2\n179.9,0,3\n");
  session.write("west.csv", "lon,lat,z\n-179.9,0,1\n-179.5,1,2\n-179.5,0,3\n");
  const Session::Result points =
      session.run("encode east.csv west.csv --units degree:metre -o points.mtin");
  REQUIRE(points.code == 0);
  CHECK(contains(points.out + points.err, "to 180.5"));
  CHECK(session.run("height points.mtin -- -179.5 0").out == "3\n");
  CHECK(session.run("height points.mtin 179.9 0").out == "3\n");
  session.write("cells/N00E010.hgt", cell("\1\1\1\1\1\1\1\1\1"));
  const Session::Result wide = session.run("encode cells --max-error 0 -o wide.mtin");
  CHECK(wide.code == 0);
  CHECK(session.run("height wide.mtin -- -179.5 0.5").out == "5\n");
}

TEST_CASE("mosaic: rasters that touch or overlap are one, the first counts, gaps are void") {
  const Session session;
  session.write("a.asc", grid(100, 50, "1 2 3\n4 5 6"));
  session.write("b.asc", grid(104, 50, "4 5 6\n9.5 8 9"));  // shares a column with the first
  session.write("c.asc", grid(100, 56, "-9 7 7\n7 7 7"));   // a row apart
  for (const std::string output : {"t.mtin", "t.mtp --tile-vertices 100"}) {
    const std::string out = session.run("encode a.asc b.asc c.asc -o " + output).out;
    CHECK(contains(out,
                   "3 files; where they overlap they differ by up to 3.5, most at x 104, y 50 in "
                   "a.asc and b.asc; the first one counts"));
    const std::string file = output.substr(0, output.find(' '));
    CHECK(session.run("verify " + file + " a.asc b.asc c.asc").code == 0);
    CHECK(session.run("verify " + file + " a.asc c.asc b.asc").code == 0);
    REQUIRE(session.run("decode " + file + " -o back.asc").code == 0);
    CHECK(contains(session.read("back.asc"),
                   "ncols 5\nnrows 5\nxllcenter 100\nyllcenter 50\ncellsize 2\nNODATA_value -9999\n"
                   "-9999 7 7 -9999 -9999\n7 7 7 -9999 -9999\n-9999 -9999 -9999 -9999 -9999\n"
                   "1 2 3 5 6\n4 5 6 8 9\n"));
  }
  const auto swapped = session.run("verify t.mtin b.asc a.asc c.asc");
  CHECK(swapped.code == 1);
  CHECK(contains(swapped.err, "the surface is below the source by up to 3.5; the header states"));
  CHECK(contains(swapped.out, "source: \"3 files; where they overlap they differ by up to "));
  CHECK(
      contains(session.run("encode a.asc c.asc -o u.mtin").out, "2 files, none of which overlap"));
}

TEST_CASE("mosaic: the place of the largest difference, wherever it is") {
  const Session session;
  const auto heights = [](int rows, int columns, int at, const char* there) {
    std::string text;
    for (int i = 0; i < rows * columns; ++i) {
      text += i == at ? there : "1";
      text += i % columns < columns - 1 ? ' ' : '\n';
    }
    return text;
  };
  const auto write = [&](const std::string& name, int x, int y, int rows, const std::string& text) {
    session.write(name, "ncols 3\nnrows " + std::to_string(rows) + "\nxllcenter " +
                            std::to_string(x) + "\nyllcenter " + std::to_string(y) +
                            "\ncellsize 2\n" + text);
  };
  write("a.asc", 100, 50, 70, heights(70, 3, -1, ""));
  for (int column = 1; column < 3; ++column) {
    for (const int row : {0, 1, 63, 64, 68}) {  // rows from the south, compared 64 at a time
      write("b.asc", 102, 50, 69, heights(69, 3, (68 - row) * 3 + column - 1, "4"));
      write("c.asc", 98, 48, 70, heights(70, 3, 0, "2"));
      const std::string place =
          "x " + std::to_string(100 + 2 * column) + ", y " + std::to_string(50 + 2 * row);
      CAPTURE(place);
      const std::string said =
          session.run("encode a.asc b.asc c.asc --max-error 9 --fast -o t.mtin").out;
      CHECK(contains(said, "differ by up to 3, most at " + place + " in a.asc and b.asc;"));
      CHECK(contains(session.run("encode c.asc b.asc a.asc --max-error 9 --fast -o t.mtin").out,
                     "differ by up to 3, most at " + place + " in "));
    }
  }
}

TEST_CASE("mosaic: a folder of SRTM cells" * kSlow) {
  const Session session;
  fs::create_directory(session.folder() + "/cells");
  session.write("cells/N43E007.hgt", cell("123456789"));
  session.write("cells/N43E008.hgt", cell("345678901"));
  session.write("cells/readme.txt.old", "no terrain");
  const std::string out =
      session.run("encode cells --max-error 0.5 --tile-vertices 60 -o t.mtp").out;
  CHECK(contains(out, "source: 15 posts, 2 files, which agree where they overlap"));
  CHECK(session.run("verify t.mtp cells").code == 0);
  CHECK(contains(session.run("info t.mtp").out,
                 "extent: {\"west\": 7.0, \"south\": 43.0, \"east\": 9.0, \"north\": 44.0}"));
  CHECK(session.run("render t.mtp --source cells -o t.png").code == 0);
  CHECK(session.run("render --source cells/N43E007.hgt --source cells/N43E008.hgt t.mtp -o u.png")
            .code == 0);
  CHECK(session.read("t.png") == session.read("u.png"));
  for (const char* const order :
       {"t.mtp --source cells/*.hgt -o v.png", "--source cells/*.hgt t.mtp -o v.png",
        "-o v.png --source cells t.mtp",
        "--source cells/N43E007.hgt t.mtp -o v.png --source "
        "cells/N43E008.hgt"}) {
    fs::remove(session.folder() + "/v.png");
    CHECK_MESSAGE(session.run(std::string("render ") + order).code == 0, order);
    CHECK_MESSAGE(session.read("t.png") == session.read("v.png"), order);
  }
  CHECK(session.failure("render --source cells/N43E007.hgt -o w.png", 2) ==
        "STREAM is required; see \"microtin help render\"\n");
  CHECK(session.failure("render --source t.mtp -o w.png", 2) ==
        "--source: names a stream, and no terrain; see \"microtin help render\"\n");
  fs::create_directory(session.folder() + "/empty");
  CHECK(contains(session.failure("encode empty -o e.mtin"), "empty: holds no terrain file"));
}

TEST_CASE("mosaic: anything in a folder except files is skipped") {
  const Session session;
  fs::create_directories(session.folder() + "/cells/folder.asc");
  session.write("cells/a.asc", grid(100, 50, "1 2 3\n4 5 6"));
  fs::create_symlink("b.asc", session.folder() + "/cells/b.asc");  // to itself
  fs::create_symlink("nowhere", session.folder() + "/cells/c.asc");
  session.write("cells/._a.asc", "attributes of macOS");
  CHECK(contains(session.run("encode cells -o t.mtin").out, "source: 6 posts\n"));
}

TEST_CASE("mosaic: more files than may be open to begin with") {
  const Session session;
  fs::create_directory(session.folder() + "/cells");
  for (int i = 0; i < 40; ++i) {
    session.write("cells/N43E0" + std::to_string(10 + i) + ".hgt", cell("123456789"));
  }
  const std::string encode = "microtin encode cells --tile-vertices 60 -o t.mtp";
  CHECK(contains(session.shell("ulimit -Sn 30; " + encode).out, "40 files"));
  CHECK(contains(session.shell("ulimit -n 30; " + encode).err, "Too many open files"));
}

TEST_CASE("mosaic: files that do not go together are refused by name") {
  const Session session;
  session.write("a.asc", grid(100, 50, "1 2 3\n4 5 6"));
  session.write("size.asc", grid(106, 50, "1 2 3\n4 5 6", "2.01"));
  session.write("off.asc", "ncols 2\nnrows 1\nxllcenter 105.2\nyllcenter 50\ncellsize 2\n1 2\n");
  session.write("unit.asc", grid(106, 50, "1 2 3\n4 5 6"));
  session.write("unit.prj", "LOCAL_CS[\"a\",UNIT[\"Foot\",0.3048]]");
  session.write("p.xyz", "0 0 0\n1 0 0\n0 1 0\n");
  CHECK(contains(session.failure("encode a.asc size.asc -o t.mtp --tile-vertices 60"),
                 "size.asc: its cells are 2.01 x 2.01, those of a.asc are 2 x 2: bring all onto"));
  CHECK(contains(session.failure("encode a.asc off.asc -o t.mtin"),
                 "off.asc: its posts lie between those of a.asc: bring all onto one grid"));
  CHECK(contains(
      session.failure("encode a.asc unit.asc -o t.mtin"),
      "unit.asc: its units or its coordinate system (x and y foot, heights unknown) are not "
      "those of a.asc (x and y unknown, heights unknown): add the missing .prj next to a.asc"));
  for (const std::string output : {"t.mtin", "t.mtp --tile-vertices 60"}) {
    const Session::Result made = session.run("encode a.asc unit.asc --epsg 32633 -o " + output);
    CHECK(contains(made.out,
                   "units: x and y metre, z metre\nwarning: x and y are taken as metre; "
                   "the file says foot\n"));
  }
  session.write("cm.asc", grid(106, 50, "100 200 300\n400 500 600"));
  session.write("cm.prj", "LOCAL_CS[\"a\",UNIT[\"m\",1]],VERT_CS[\"b\",UNIT[\"cm\",0.01]]");
  session.write("m.asc", grid(112, 50, "1 2 3\n4 5 6"));
  session.write("m.prj", "LOCAL_CS[\"a\",UNIT[\"m\",1]],VERT_CS[\"b\",UNIT[\"m\",1]]");
  REQUIRE(session.run("encode cm.asc m.asc --epsg 32633 -o t.mtin").code == 0);
  CHECK(contains(session.run("info t.mtin").out, "\"lowest\": 1.0, \"highest\": 6.0"));
  fs::create_directory(session.folder() + "/mixed");
  for (const char* const name : {"a.asc", "unit.asc", "p.xyz"}) {
    fs::copy_file(session.folder() + "/" + name, session.folder() + "/mixed/" + name);
  }
  session.write("mixed/t.obj", "v 0 0 0\n");
  CHECK(contains(session.run("encode mixed -o t.mtin").err,
                 "warning: mixed: its .asc files are taken; left out are 1 of .obj, 1 of .xyz\n"));
  CHECK(contains(session.failure("encode a.asc p.xyz -o t.mtin"), "p.xyz: are points, but a.asc"));
  session.write("far.asc", grid(106, 50, "1 2 99999999999\n4 5 6"));
  session.write("fine.asc", grid(112, 50, "1 2 0.000000001\n4 5 6"));
  CHECK(session.failure("encode far.asc fine.asc -o t.mtin") ==
        "far.asc: its heights do not fit the decimals of the other files; round them\n");
  CHECK(session.run("encode a.asc size.asc -o size.asc").code == 1);
  CHECK(session.read("size.asc") == grid(106, 50, "1 2 3\n4 5 6", "2.01"));
}

TEST_CASE("mosaic: corners may be rounded by a millionth of a cell") {
  const Session session;
  session.write("a.asc", grid(100, 50, "1 2 3\n4 5 6"));
  const auto moved = [](const std::string& x) {
    return "ncols 3\nnrows 2\nxllcenter " + x + "\nyllcenter 50\ncellsize 2\n7 8 9\n10 11 12\n";
  };
  for (const char* const x : {"105.999998", "106.000002"}) {
    session.write("b.asc", moved(x));
    REQUIRE(session.run("encode a.asc b.asc -o t.mtin").code == 0);
    CHECK(session.run("verify t.mtin a.asc b.asc").code == 0);
    REQUIRE(session.run("decode t.mtin -o back.asc").code == 0);
    CHECK(contains(session.read("back.asc"),
                   "xllcenter 100\nyllcenter 50\ncellsize 2\nNODATA_value -9999\n1 2 3 7 8 9\n"
                   "4 5 6 10 11 12\n"));
  }
  session.write("b.asc", moved("106.000003"));
  CHECK(contains(session.failure("encode a.asc b.asc -o t.mtin"), "b.asc: its posts lie between"));
}

TEST_CASE("mosaic: clouds are joined, with the decimals of both") {
  const Session session;
  session.write("a.xyz", "0 0 1\n2 0 1\n0 2 1.5\n");
  session.write("b.xyz", "2.25 2 4\n1 1 2.125\n");
  CHECK(contains(session.run("encode a.xyz b.xyz -o t.mtin").out,
                 "source: 5 points, 2 files, which share no place\n"));
  CHECK(session.run("verify t.mtin b.xyz a.xyz").code == 0);
  REQUIRE(session.run("decode t.mtin -o o.xyz").code == 0);
  CHECK(contains(session.read("o.xyz"), "2.25 2"));
}

TEST_CASE("mosaic: a cloud is not gone over again for every file that joins it") {
  const auto time_of = [](int files) {
    PointCloud large;
    for (int64_t i = 0; i < 300000; ++i) large.points.push_back({i % 1000, i / 1000, 0});
    std::vector<NamedSource> parts;
    parts.push_back({"large", std::move(large)});
    while (static_cast<int>(parts.size()) < files) {
      PointCloud small;
      small.points.push_back({0, 0, 0});
      parts.push_back({"small", std::move(small)});
    }
    const std::clock_t begin = std::clock();
    CHECK(join_clouds(std::move(parts)).points.size() == 299999u + static_cast<size_t>(files));
    return static_cast<double>(std::clock() - begin);
  };
  const double of_few = time_of(2);
  CHECK(time_of(1000) < 5 * of_few);  // 40 times that, were it so
}

TEST_CASE("mosaic: how far clouds differ where they share places") {
  const Session session;
  session.write("a.xyz", "0 0 1\n2 0 1\n0 2 1.5\n1 1 5\n1 1 5.5\n");
  session.write("b.xyz", "2 0 1\n0.5 0.5 9\n");
  session.write("c.xyz", "1 1 4.25\n2 0 2\n");
  const std::string encode = "encode a.xyz b.xyz ", rule = " --duplicates mean -o t.mtin";
  CHECK(
      contains(session.run(encode + rule).out, "2 files, which agree at 1 places that they share"));
  CHECK(contains(session.run(encode + "c.xyz" + rule).out,
                 "3 files; at 2 places that they share they differ by up to 1.25, most at x 1, y 1 "
                 "in a.xyz and c.xyz; all count\n"));
  session.write("d.xyz", "2 0 -1\n0 0 1\n");
  CHECK(
      contains(session.run("encode a.xyz b.xyz c.xyz d.xyz" + rule).out,
               "at 3 places that they share they differ by up to 3, most at x 2, y 0 in c.xyz and "
               "d.xyz; all count\n"));
}

TEST_CASE("mosaic: a folder of scans is verified by the classes that were taken") {
  const Session session;
  fs::create_directory(session.folder() + "/scans");
  session.write("scans/a.las", scan());
  session.write("a.laz", compressed(scan()));
  for (const std::string name : {"scans", "a.laz"}) {
    REQUIRE(session.run("encode " + name + " --classes 2,5 -o t.mtin").code == 0);
    CHECK(contains(session.run("verify t.mtin " + name).out, "points: 4\n"));
    CHECK(session.run("render t.mtin -o t.png --width 300 --source " + name).code == 0);
  }
}

TEST_CASE("clouds: the memory that they need is reported before they are read") {
  const Session session;
  std::string las(227, '\0');
  las.replace(0, 4, "LASF");
  las[24] = 1;
  las[25] = 2;
  las.replace(107, 4, std::string("\0\x2D\x31\x01", 4));  // 20,000,000
  session.write("a.las", las);
  session.write("b.LAZ", las);
  const std::string told = session.run("encode a.las b.LAZ --tile-vertices 500 -o t.mtp").err;
  CHECK(contains(told,
                 "warning: a.las: about 40000000 points take about 7.2 GB of memory; this "
                 "machine has "));
  CHECK(told.find("memory") < told.find("microtin: a.las: "));
  CHECK(contains(session.run("encode a.las -o t.mtin").err, "about 2 GB of memory"));
  session.write("a.xyz", "0 0 1\n2 0 1\n0 2 1.5\n");
  CHECK(!contains(session.run("encode a.xyz -o t.mtin").err, "memory"));
}
