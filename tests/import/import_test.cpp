// SPDX-License-Identifier: MIT
// Reading terrains.
#include "encoder/import/import.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>

#include "encoder/base/error.hpp"
#include "tests/support/imports.hpp"
#include "tests/support/join.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace microtin::tests;

namespace {

std::string error_of(Raster (*import)(const std::string&, const std::string&),
                     const std::string& text) {
  return import_error([&] { import("grid", text); });
}

std::string grid_error(const std::string& text) {
  return error_of(import_asc, text);
}

std::string point_error(const std::string& text) {
  return import_error([&] { import_points("cloud", text); });
}

std::string points(const std::string& text) {
  return text_of(import_points("cloud", text));
}

const std::string kHeader = "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 10\n";

}  // namespace

TEST_CASE("asc: rows are turned to the south first, posts lie at cell centres") {
  const Raster raster = import_asc("grid", kHeader + "1 2 3\n4 5 6\n");
  CHECK(raster.width == 3);
  CHECK(raster.height == 2);
  CHECK(raster.decimals == 0);
  CHECK(raster.heights == std::vector<int64_t>{4, 5, 6, 1, 2, 3});
  CHECK(raster.x.offset == 105);
  CHECK(raster.x.numerator == 10);
  CHECK(raster.x.denominator == 1);
  CHECK(raster.y.offset == 205);
}

TEST_CASE("asc: centre, any case, any order, any line breaks, exponents, voids") {
  const Raster raster = import_asc(
      "grid",
      "NODATA_value -9999\r\nCELLSIZE 0.000833333333\r\nYllCenter 43\r\nXLLCENTER 7\r\nNROWS 2 "
      "ncols\n2\r\n  1e0 -9999.000\n\n\t.5\r\n-0.125");
  CHECK(raster.decimals == 3);
  CHECK(raster.heights == std::vector<int64_t>{500, -125, 1000, kVoidHeight});
  CHECK(raster.x.offset == 8400);
  CHECK(raster.x.denominator == 1200);
  CHECK(raster.y.offset == 51600);
}

TEST_CASE("asc: dx and dy, a step beyond 40 bits is met within its digits") {
  const Raster raster =
      import_asc("grid", "ncols 1 nrows 1 xllcenter 0 yllcenter 0 dx 2.5 dy 4.988744589123 7");
  CHECK(raster.x.numerator == 5);
  CHECK(raster.x.denominator == 2);
  const long double step =
      static_cast<long double>(raster.y.numerator) / static_cast<long double>(raster.y.denominator);
  CHECK(std::abs(step - 4.988744589123L) < 0.6e-12L);
}

TEST_CASE("asc: a void value that no height can have is known by its text") {
  const std::string huge = "-3.40282346638529e+38";
  const Raster raster =
      import_asc("grid", kHeader + "NODATA_value " + huge + "\n1 " + huge + " 3\n4 5 " + huge);
  CHECK(raster.heights == std::vector<int64_t>{4, 5, kVoidHeight, 1, kVoidHeight, 3});
  CHECK(grid_error(kHeader + "1 2 3\n4 5 " + huge) ==
        "grid:7: \"" + huge +
            "\" is not a number in range; if it marks voids, the header's NODATA_value must be the "
            "same");
}

TEST_CASE("texts may begin with a byte order mark") {
  const std::string mark = "\xEF\xBB\xBF";
  CHECK(import_asc("grid", mark + kHeader + "1 2 3\n4 5 6").heights.size() == 6);
  const std::string text = mark + kHeader + "1 2 3\n4 5 6";
  const auto reader = open_asc("grid", bytes_in_memory({text.begin(), text.end()}));
  CHECK(reader->read({0, 0, 3, 2}).heights == std::vector<int64_t>{4, 5, 6, 1, 2, 3});
  CHECK(grid_error(mark + kHeader + "1 2 3\n4 x 6\n") == "grid:7: \"x\" is not a number in range");
  CHECK(grid_error(mark) == "grid: the header lacks ncols");
  CHECK(points(mark + "1 2 3") == "1,2,3");
  CHECK(text_of(import_obj("mesh", mark + "v 1 2 3\nv 4 5 6\n")) == "1,2,3 4,5,6");
  CHECK(text_of(import_ply(
            "mesh", mark + "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\n"
                           "property int y\nproperty int z\nend_header\n1 2 3\n")) == "1,2,3");
}

TEST_CASE("asc: cells that are not numbers are void, whatever no-data value the header has") {
  const std::string size = "ncols 3\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
  const std::vector<int64_t> voids = {kVoidHeight, 2, kVoidHeight};
  for (const char* const text : {"nodata_value nan\nnan 2 NaN", "nan 2 -nan", "NAN 2 nan(ind)",
                                 "nodata_value -9\nnan 2 -9"}) {
    CHECK(import_asc("grid", size + text).heights == voids);
    const std::string all = size + text;
    CHECK(open_asc("grid", bytes_in_memory({all.begin(), all.end()}))->read({0, 0, 3, 1}).heights ==
          voids);
  }
  CHECK_THROWS_AS(import_asc("grid", size + "nanx 2 3"), Error);
}

TEST_CASE("asc: every error names its line") {
  CHECK(grid_error(kHeader + "1 2 3\n4 5\n") == "grid:8: the grid ends after 5 of 6 heights");
  CHECK(grid_error(kHeader + "1 2 3\n4 5 6\n7\n") ==
        "grid:8: the grid has more numbers than its 6 heights");
  CHECK(grid_error(kHeader + "1 2 3\n4 x 6\n") == "grid:7: \"x\" is not a number in range");
  const std::string rows = "1 2 3\n4 MARK 6\n";
  for (const std::string mark : {"inf", "-3.4e38"}) {
    const std::string marked = std::string(rows).replace(rows.find("MARK"), 4, mark);
    CHECK(grid_error(kHeader + marked) ==
          "grid:7: \"" + mark +
              "\" is not a number in range; if it marks voids, the header's NODATA_value must be "
              "the same");
    std::string declared = kHeader;
    declared.append("NODATA_value ").append(mark).append("\n").append(marked);
    CHECK(import_asc("grid", declared).heights == std::vector<int64_t>{4, kVoidHeight, 6, 1, 2, 3});
  }
  CHECK(grid_error(kHeader + "1,5 2 3\n4 5 6\n") ==
        "grid:6: \"1,5\" is not a number in range; decimals are written with a point");
  CHECK(grid_error(kHeader + "1e17 2 3\n4 0.5 .000000001\n") ==
        "grid:7: \".000000001\" is not a number in range");
  CHECK(grid_error(kHeader + "nodata_value abc\n1 2 3") == "grid:6: \"abc\" is not a number");
  CHECK(grid_error(kHeader + "\x01\x02\xFF") == "grid:6: \"???\" is not a number in range");
  CHECK(grid_error(kHeader + "ncols 4\n1") == "grid:6: ncols is given twice");
  CHECK(grid_error(kHeader + "nodata_value -9\nNODATA_value -1\n1") ==
        "grid:7: nodata_value is given twice");
  CHECK(grid_error(kHeader + "dx 10\ndy 20\n1 2 3\n4 5 6") ==
        "grid: cellsize and dy are both given; keep one");
  CHECK(import_asc("grid", kHeader + "dx 10.0\ndy 1e1\n1 2 3\n4 5 6").width == 3);
  CHECK(grid_error(kHeader + "zone 4\n1") ==
        "grid:6: \"zone\" is neither a number nor a key of an ASCII grid's header");
  CHECK(grid_error("ncols") == "grid:1: the value of ncols is missing");
  CHECK(grid_error("ncols x") == "grid:1: ncols is not a number in range: \"x\"");
  CHECK(grid_error("") == "grid: the header lacks ncols");
  CHECK(grid_error("ncols 2\nnrows 0 1") == "grid: nrows is not a count: 0");
  CHECK(grid_error("ncols 2.5\nnrows 1 1") == "grid: ncols is not a count: 2.5");
  CHECK(grid_error("ncols 1 nrows 1 yllcorner 0 cellsize 1 5") ==
        "grid: the header lacks xllcorner");
  CHECK(grid_error("ncols 1 nrows 1 xllcorner 0 yllcorner 0 5") ==
        "grid: the header lacks cellsize");
  CHECK(grid_error("ncols 1 nrows 1 xllcorner 0 yllcorner 0 cellsize -1 5") ==
        "grid: cellsize is not above 0");
  CHECK(grid_error("ncols 2000000000 nrows 2000000000 xllcorner 0 yllcorner 0 cellsize 1 5 6") ==
        "grid:1: the grid ends after 2 of 4000000000000000000 heights");
  CHECK(grid_error("ncols 1 nrows 1 xllcorner 0 yllcorner 0 cellsize 1e17 5") ==
        "grid: the coordinates, the heights or their steps are out of the format's range");
}

TEST_CASE("hgt: big-endian from the north, its place in exact degrees") {
  std::string bytes(size_t{2} * 1201 * 1201, '\0');
  bytes[0] = '\x01';  // north-west post: 0x0102
  bytes[1] = '\x02';
  bytes[2] = '\xFF';  // the next: -2
  bytes[3] = '\xFE';
  bytes[bytes.size() - 2] = '\x80';  // south-east: void
  const Raster raster = import_hgt("some/where/s05W072.hgt", bytes);
  CHECK(raster.width == 1201);
  CHECK(raster.heights[size_t{1200} * 1201] == 258);
  CHECK(raster.heights[size_t{1200} * 1201 + 1] == -2);
  CHECK(raster.heights[1200] == kVoidHeight);
  CHECK(raster.heights[0] == 0);
  CHECK(raster.x.offset == -72 * 1200);
  CHECK(raster.x.numerator == 1);
  CHECK(raster.x.denominator == 1200);
  CHECK(raster.y.offset == -5 * 1200);
  CHECK(raster.reference.horizontal_unit == Unit::kDegree);
  CHECK(raster.reference.horizontal_epsg == 4326);
  CHECK(raster.reference.vertical_epsg == 5773);
}

TEST_CASE("hgt: other sizes and names are refused") {
  const std::string bytes(size_t{2} * 1201 * 1201, '\0');
  CHECK(error_of(import_hgt, bytes).find("grid: the file's name") == 0);
  CHECK(error_of(import_hgt, bytes + "x").find("grid: has 2884803 bytes") == 0);
  CHECK(error_of(import_hgt, "").find("grid: has 0 bytes") == 0);
  CHECK_THROWS_AS(import_hgt("N91E007.hgt", bytes), Error);
  CHECK_THROWS_AS(import_hgt("N43E0071.hgt", bytes), Error);
  CHECK_NOTHROW(import_hgt("N43E007.SRTMGL3.hgt", bytes));
}

TEST_CASE("hgt: fewer columns than rows, as towards the poles") {
  std::string bytes(size_t{2} * 1801 * 3601, '\0');
  bytes[2 * 1801 * 3600 + 1] = '\x07';  // south-west post
  const Raster raster = import_hgt("N55E010.hgt", bytes);
  CHECK(raster.width == 1801);
  CHECK(raster.height == 3601);
  CHECK(raster.heights[0] == 7);
  CHECK(raster.x.offset == 10 * 1800);
  CHECK(raster.x.denominator == 1800);
  CHECK(raster.y.offset == 55 * 3600);
  CHECK(raster.y.denominator == 3600);
  for (const size_t columns : {601U, 401U, 301U, 201U}) {
    CHECK(import_hgt("N80E010.hgt", std::string(2 * columns * 1201, '\0')).width == columns);
  }
  CHECK(error_of(import_hgt, std::string(size_t{2} * 1800 * 3601, '\0')) ==
        "grid: has 12963600 bytes; an .hgt file has two for each post of a square, as 25934402 for "
        "3601 x 3601, or of 1801 x 3601, for example, towards the poles");
}

TEST_CASE("a grid is known by its content where its name may be that of points") {
  const TemporaryFolder folder;
  const std::string system = R"(PROJCS["WGS_1984_UTM_Zone_33N",UNIT["Meter",1.0]])";
  std::ofstream(folder / "grid.prj") << system;
  for (const char* const name : {"grid.txt", "grid.xyz", "grid.csv"}) {
    const std::string path = folder / name;
    std::ofstream(path) << "\n  " << kHeader << "1 2 3\n4 5 6\n";
    const Raster raster = std::get<Raster>(import_terrain(path));
    CHECK(raster.heights == std::vector<int64_t>{4, 5, 6, 1, 2, 3});
    CHECK(raster.reference.horizontal_epsg == 32633);
    const OpenSource opened = open_terrain(path);
    const Raster& frame = std::get<std::unique_ptr<RasterReader>>(opened)->frame();
    CHECK(frame.width == 3);
    CHECK(frame.reference.horizontal_epsg == 32633);
    CHECK(terrain_files(path, Indirect::kRefused).size() == 2);
  }
  CHECK(is_grid("NODATA_value -9\nncols 2"));
  CHECK_FALSE(is_grid("x y z\n1 2 3"));
  CHECK_FALSE(is_grid(""));
}

TEST_CASE("points: separators, comments, headers, two columns") {
  CHECK(points("1 2 3\n4\t5\t6\r\n7,8,9\n10;11;12\n") == "1,2,3 4,5,6 7,8,9 10,11,12");
  CHECK(points("  1 , 2 ,\n\n # x y\n 3  4") == "1,2,0 3,4,0");
  CHECK(points("\"X\",\"Y\",\"Z\"\n1,2.5,3") == "10,25,3");
  CHECK(points("\xEF\xBB\xBFlon lat height\n-1 0 0.25\n1 0 -1e1") == "-1,0,25 1,0,-1000");
  CHECK(points("lat,lon,ele\n50,7,100\n51,8,200\n") == "7,50,100 8,51,200");
  CHECK(points("id;northing;easting;class;HEIGHT\n9;2;1;5;3\n") == "1,2,3");
  CHECK(points("y x\n1 2\n3 4\n") == "2,1,0 4,3,0");
  CHECK(points("Northing [m], Easting (m) ,\"Height above sea\"\r\n1,2,3\n") == "2,1,3");
  CHECK(points("Y[ft] X[ft] Z[ft]\n1 2 3\n") == "2,1,3");
  CHECK(points("N,E,H\n1,2,3\n") == "2,1,3");
  CHECK(points("//Y X Z R G B\n1 2 3 255 255 0\n") == "2,1,3");
  CHECK(points("x,y,z\n1,2,3,255\n") == "1,2,3");
  CHECK(points("OBJECTID,POINT_X,POINT_Y,POINT_Z\n9,1,2,3\n") == "1,2,3");
  CHECK(points("\"1\",\"2.5\",\"3\"\n1, 2 ,3 \n") == "10,25,3 10,20,3");
  CHECK(import_points("c", "lat,lon\n1,2\n").reference.horizontal_unit == Unit::kDegree);
  CHECK(import_points("c", "y,x\n1,2\n").reference.horizontal_unit == Unit::kUnknown);
  CHECK(points("1 2 3 255 0.5\n4 5 6 0 1e-3\n") == "1,2,3 4,5,6");
  CHECK(import_points("cloud", "1.25 2 3.5").xy_decimals == 2);
  CHECK(import_points("cloud", "1.25 2 3.5").z_decimals == 1);
}

TEST_CASE("points: named columns are taken, whatever stands in others") {
  CHECK(points("P,N,E,Z,D\n1,4500000.5,500000,100,edge of road\nB2,4500010,500010,101,\n"
               "\"3\",4500020,500020,102,\"fence, wood \"\"old\"\"\"\n") ==
        "5000000,45000005,100 5000100,45000100,101 5000200,45000200,102");
  CHECK(points("Point;Northing;Easting;Elevation;Description\nA-1;2;1;3;tree, 4 m\nA-2;5;4;6;\n") ==
        "1,2,3 4,5,6");
  CHECK(points("code,\"Height, above sea\",x,y\nabc,3,1,2\n") == "1,2,3");
  CHECK(points("P\tN\tE\tZ\tD\nb1\t2\t1\t3\ttree\n") == "1,2,3");
  CHECK(points("id x y z\na1 1 2 3\n") == "1,2,3");
  CHECK(points("x,y,z,remark\n1,2,3,nan\n") == "1,2,3");
  CHECK(point_error("P,N,E,Z,D\n1,2,3,tree,4\n") == "cloud:2: \"tree\" is not a number in range");
  const std::string quotes =
      " names; decimals are written with a point, and texts with commas between quotes";
  CHECK(point_error("P,N,E,Z,D\n1,2,3,4,fence, wood\n") == "cloud:2: 6 columns under 5" + quotes);
  CHECK(point_error("P,N,E,Z,D\n1,4500000,25,500000,50,100,00,\n") ==
        "cloud:2: 7 columns under 5" + quotes);
  CHECK(point_error("P N E Z D\n1 2 3 4 edge of road\n") ==
        "cloud:2: 7 columns under 5 names: texts with blanks need commas or semicolons between the "
        "columns");
  CHECK(point_error("P,N,E,Z,D\n1,2,3,4,5\n1,2,3,4\n") == "cloud:3: 4 columns after lines of 5");
}

TEST_CASE("points: decimal commas are refused, whatever separates the numbers") {
  const std::string remedy = "; decimals are written with a point";
  CHECK(point_error("P;N;E;Z;D\n1;4500000,25;500000,5;100,2;tree\n") ==
        "cloud:2: \"500000,5\" is not a number in range" + remedy);
  CHECK(point_error("x,y,z\n1,5,20,25,301\n") ==
        "cloud:2: 5 columns under 3 names" + remedy + ", and texts with commas between quotes");
  CHECK(point_error("500000,25,4500000,50,100,00\n") ==
        "cloud:1: a number after a comma begins with 0, as decimals do, which are written with a "
        "point");
  CHECK(points("1.5,2.5,3.5,255,0,07\n") == "15,25,35");
  CHECK(points("1,2,3,255,0,0\n") == "1,2,3");
}

TEST_CASE("texts whose lines end with CR alone") {
  CHECK(points("x,y,z\r1,2,3\r\r4,5,6\r") == "1,2,3 4,5,6");
  CHECK(point_error("1 2 3\r4 5 x\r\n") == "cloud:2: \"x\" is not a number in range");
  std::string grid = kHeader + "1 2 3\n4 x 6\n";
  std::replace(grid.begin(), grid.end(), '\n', '\r');
  CHECK(grid_error(grid) == "grid:7: \"x\" is not a number in range");
  grid[grid.rfind('x')] = '5';
  CHECK(import_asc("grid", grid).heights == std::vector<int64_t>{4, 5, 6, 1, 2, 3});
}

TEST_CASE("asc: each axis goes by its own key, corner or centre") {
  const std::string size = "ncols 2\nnrows 2\ncellsize 10\n", heights = "1 2\n3 4\n";
  for (const bool x_centre : {false, true}) {
    for (const bool y_centre : {false, true}) {
      const Raster raster =
          import_asc("grid", join({size, x_centre ? "xllcenter 100\n" : "xllcorner 100\n",
                                   y_centre ? "yllcenter 200\n" : "yllcorner 200\n", heights}));
      CHECK(raster.x.offset == (x_centre ? 100 : 105));
      CHECK(raster.y.offset == (y_centre ? 200 : 205));
    }
  }
  CHECK(grid_error(size + "xllcenter 1\nxllcorner 1\nyllcorner 2\n" + heights) ==
        "grid: xllcorner and xllcenter are both given; keep one");
}

TEST_CASE("points: positions outside the Earth's degrees are refused if columns have such names") {
  CHECK(points("lat,lon\n-90,360\n90,-360") == "360,-90,0 -360,90,0");
  const std::string remedy = " degrees: name the columns as they are, x,y,z for others";
  CHECK(point_error("lon,lat,z\n45.5,7,1\n45.5,107.25,1\n") ==
        "cloud:3: latitude 107.25 is beyond 90" + remedy);
  CHECK(point_error("lat;lon\n-90.5;7\n") == "cloud:2: latitude -90.5 is beyond 90" + remedy);
  CHECK(point_error("lat,lon\n45,600000\n") == "cloud:2: longitude 600000 is beyond 360" + remedy);
}

TEST_CASE("points: every error names its line") {
  CHECK(point_error("") == "cloud: holds no point");
  CHECK(point_error("# nothing\nx y z\n") == "cloud: holds no point");
  CHECK(point_error("1 2 3\n4 5 NaN") == "cloud:2: \"NaN\" is not a number in range");
  CHECK(point_error("1 2 abc\n") == "cloud:1: \"abc\" is not a number in range");
  CHECK(point_error("x y z\nx y z\n") == "cloud:2: \"x\" is not a number in range");
  CHECK(point_error("1,,3\n") == "cloud:1: \"\" is not a number in range");
  CHECK(point_error("\n\n5\n") == "cloud:3: a point needs two or three numbers");
  CHECK(point_error("1 2 3\n4 5\n") == "cloud:2: 2 columns after lines of 3");
  CHECK(point_error("1 2 3 4\n1 2 3 q\n") == "cloud:2: \"q\" is not a number in range");
  CHECK(point_error("1,5;2,5;3,5\n") ==
        "cloud:1: commas and semicolons are mixed; decimals are written with a point");
  for (const char* line : {"1,5 20,25 301,5\n", "1,5\t20,25\t301,5\n", "1, 2,3 4\n"}) {
    CHECK(point_error(line) ==
          "cloud:1: commas and blanks are mixed; decimals are written with a point");
  }
  CHECK(point_error("x,y,z\n1,5,20,25,301,5\n") ==
        "cloud:2: 6 columns under 3 names; decimals are written with a point");
  for (const char* line : {"OBJECTID,EAST_X,NORTH_Y\n1,2,3\n", "a b c\n1 2 3\n"}) {
    CHECK(point_error(line) ==
          "cloud:1: no column is named as x, y or z: name these, or begin the line with # if they "
          "are first");
  }
  const std::string unclear =
      "cloud:1: the header names some of x, y and z: it must name all, or x and y alone";
  CHECK(point_error("z,a,b\n1,2,3\n") == unclear);
  CHECK(point_error("Hochwert;Rechtswert;H\n1;2;3\n") == unclear);
  CHECK(point_error("id,class,z\n1,2,3\n") == unclear);
  CHECK(point_error("x,a,b\n1,2,3\n") == unclear);
  CHECK(point_error("x,y,class\n1,2,3\n") == unclear);
  CHECK(point_error("id,x,y\n1,2,3\n") == unclear);
  CHECK(point_error("x,lon,y\n1,2,3\n") == "cloud:1: two columns are named as x");
  CHECK(point_error("a,b,x,y\n1,2\n") == unclear);
  const std::string blanks =
      " names: a number is missing, or blanks in names need commas between them";
  CHECK(point_error("z,a,x,y\n1,2\n") == "cloud:2: 2 columns under 4" + blanks);
  CHECK(point_error("x,y,z\n1,2,\n") == "cloud:2: 2 columns under 3" + blanks);
  CHECK(point_error("x y z\n1 2\n") == "cloud:2: 2 columns under 3" + blanks);
  CHECK(point_error("X [m] Y [m] Z [m]\n1 2 3\n") == "cloud:2: 3 columns under 6" + blanks);
  CHECK(import_points("c", "lon,lat,depth\n7,45,20\n").reference.depths);
  CHECK(!import_points("c", "x,depth,y,z\n1,2,3,4\n").reference.depths);
  CHECK(points("x,depth,y,z\n1,2,3,4\n") == "1,3,4");
  CHECK(point_error("1 2 3\n1e300 2 3") == "cloud:2: \"1e300\" is not a number in range");
  CHECK(point_error("0.000000001 1\n10000000000 2") ==
        "cloud:2: \"10000000000\" is not a number in range");
  CHECK(point_error(std::string("1 2\0003\n", 6)) == "cloud:1: \"2?3\" is not a number in range");
}

TEST_CASE("files that are not there, or of no known kind, are refused by name") {
  const auto error = [](const std::string& path) {
    return import_error([&] { import_terrain(path); });
  };
  CHECK(error("no/such.asc") == "no/such.asc: cannot be read: No such file or directory");
#ifndef MICROTIN_WITH_GDAL
  CHECK(error("terrain.tif") == "terrain.tif: cannot be read: No such file or directory");
  CHECK(error("terrain") == "terrain: cannot be read: No such file or directory");
  const TemporaryFolder folder;
  const std::string path = folder / "terrain.tif";
  std::ofstream(path) << "II";
  CHECK(error(path) ==
        path +
            ": is not a kind of terrain file that microtin reads: .hgt, .zip, .asc, .xyz, .csv, "
            ".txt, .las, .laz, "
            ".ply, .obj; for others use \"gdal_translate -of AAIGrid IN OUT.asc\", or build with "
            "-DMICROTIN_WITH_GDAL=ON");
#endif
}

TEST_CASE("real files are read") {
  if (const std::string path = data_file("srtm_rmnp.asc"); !path.empty()) {
    const Raster raster = std::get<Raster>(import_terrain(path));
    CHECK(raster.heights.size() == 240 * 144);
    CHECK(raster.heights[143 * 240] == 2569);
    CHECK(raster.x.numerator * 1200 == raster.x.denominator);
  }
  if (const std::string path = data_file("bijou5m.asc"); !path.empty()) {
    const Raster raster = std::get<Raster>(import_terrain(path));
    CHECK(raster.decimals == 9);
    CHECK(raster.heights[76 * 105] == 1726645996094);
  }
  if (const std::string path = data_file("hugo.asc"); !path.empty()) {
    const Raster raster = std::get<Raster>(import_terrain(path));
    CHECK(raster.heights.size() == 76 * 55);
    CHECK(std::count(raster.heights.begin(), raster.heights.end(), kVoidHeight) == 2028);
  }
  if (const std::string path = data_file("quebec_forest_ground.xyz"); !path.empty()) {
    const PointCloud cloud = std::get<PointCloud>(import_terrain(path));
    CHECK(cloud.points.size() == 12056);
    CHECK(cloud.xy_decimals == 3);
    CHECK(cloud.points[0].y == 5274357669);
  }
}
