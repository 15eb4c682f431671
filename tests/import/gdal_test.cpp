// SPDX-License-Identifier: MIT
// Rasters read by GDAL, in builds with it.
#include <doctest/doctest.h>

#include "encoder/import/import.hpp"
#include "tests/support/imports.hpp"
#include "tests/support/session.hpp"

using namespace microtin::tests;

#ifndef MICROTIN_WITH_GDAL

TEST_CASE("gdal: not in this build") {
  MESSAGE("skipped: built without -DMICROTIN_WITH_GDAL=ON");
}

#else

namespace {

// A file of the given GDAL virtual format (.vrt) over an ASCII grid.
std::string vrt(const std::string& transform, const std::string& band) {
  return "<VRTDataset rasterXSize=\"3\" rasterYSize=\"2\"><GeoTransform>" + transform +
         "</GeoTransform><SRS>EPSG:32633</SRS><VRTRasterBand band=\"1\" dataType=" + band +
         "<SimpleSource><SourceFilename relativeToVRT=\"1\">t.asc</SourceFilename>"
         "<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>";
}

const std::string kPlace = "500000, 10, 0, 200, 0, -10";

struct Grid {
  Grid() {
    session.write("t.asc",
                  "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 10\n1 2 3\n4 5 6\n");
  }
  Raster read(const std::string& text) const {
    session.write("t.vrt", text);
    return std::get<Raster>(import_terrain(session.folder() + "/t.vrt", {}, Indirect::kAllowed));
  }
  std::string error(const std::string& text) const {
    const std::string all = import_error([&] { read(text); });
    return all.substr(std::min(all.size(), session.folder().size() + 1));
  }
  Session session;
};

}  // namespace

TEST_CASE("gdal: rows to the south first, place, code, units, voids, scale") {
  const Grid grid;
  const Raster raster = grid.read(
      vrt(kPlace,
          "\"Int16\"><NoDataValue>5</NoDataValue><UnitType>ft</UnitType><Scale>0.1</Scale>"
          "<Offset>-2</Offset>"));
  CHECK(raster.heights == std::vector<int64_t>{-16, kVoidHeight, -14, -19, -18, -17});
  CHECK(raster.decimals == 1);
  CHECK(raster.x.offset == 500005);
  CHECK(raster.y.offset == 185);
  CHECK(raster.reference.horizontal_epsg == 32633);
  CHECK(raster.reference.horizontal_unit == Unit::kMetre);
  CHECK(raster.reference.vertical_unit == Unit::kFoot);
  CHECK(grid.read(vrt("7, 0.000833333333333333, 0, 44, 0, -0.000833333333333333", "\"Float32\">"))
            .x.denominator == 2400);
}

TEST_CASE("gdal: what a file states about itself becomes notes") {
  const Grid grid;
  std::string text = vrt(kPlace, "\"Int16\"><UnitType>m</UnitType>");
  text.replace(text.find("<SRS>"), 5, "<SRS coordinateEpoch=\"2020.5\">");
  const std::string items =
      "<Metadata><MDI key=\"TIFFTAG_COPYRIGHT\">the survey</MDI>"
      "<MDI key=\"TIFFTAG_DATETIME\">2021:05:03 10:20:30</MDI>"
      "<MDI key=\"LICENSE\">CC-BY-4.0</MDI></Metadata>";
  text.insert(text.find("<VRTRasterBand"), items);
  const SourceNotes notes = grid.read(text).reference.notes;
  CHECK(notes.attribution == "the survey");
  CHECK(notes.date == "2021-05-03");
  CHECK(notes.license == "CC-BY-4.0");
  REQUIRE(notes.epoch);
  CHECK(to_string(*notes.epoch) == "2020.5");
  const std::string words = "encode t.vrt --allow-vrt --license MIT -o t.mtin";
  REQUIRE(grid.session.run(words).code == 0);
  const std::string info = grid.session.run("info t.mtin").out;
  for (const char* const line :
       {"\nattribution: \"the survey\"\n", "\nlicense: \"MIT\"\n", "\nepoch: 2020.5\n"}) {
    CHECK_MESSAGE(info.find(line) != info.npos, info);
  }
}

TEST_CASE("gdal: a band's unit is converted, and a system of depths turned, in the program too") {
  const Grid grid;
  const auto with_unit = [](const std::string& unit, const std::string& codes) {
    std::string text = vrt(kPlace, "\"Int16\"><UnitType>" + unit + "</UnitType>");
    return text.replace(text.find("EPSG:32633"), 10, codes);
  };
  CHECK(grid.read(with_unit("cm", "EPSG:32633")).reference.vertical_other == "centimetre");
  const Session& session = grid.session;
  const std::string encode = "encode t.vrt --allow-vrt -o t.mtin";
  CHECK(contains(session.run(encode).out, "centimetre are converted to metre: times 0.01\n"));
  CHECK(contains(session.run("info t.mtin").out, "\"highest\": 0.06"));
  CHECK(session.run("verify t.mtin t.vrt --allow-vrt").code == 0);
  session.write("t.vrt", with_unit("span", "EPSG:32633"));
  CHECK(contains(session.run(encode).err, "\"span\", which is not known"));
  session.write("t.vrt", with_unit("m", "EPSG:32633+5715"));
  CHECK(contains(session.run(encode).err, "heights are depths (EPSG 5715)"));
  CHECK(contains(session.run(encode + " --depths").out, "EPSG 5715 becomes EPSG 5714\n"));
  CHECK(contains(session.run("info t.mtin").out, "\"lowest\": -6"));
  CHECK(session.run("decode t.mtin --like t.vrt -o like.asc").code == 1);  // without --allow-vrt
  CHECK(session.run("decode t.mtin --allow-vrt --like t.vrt -o like.asc").code == 0);
}

TEST_CASE("gdal: files that cannot be read are refused with a remedy") {
  const Grid grid;
  CHECK(grid.error(vrt("0, -10, 0, 0, 0, 10", "\"Int16\">")) ==
        "t.vrt: its rows do not run from west to east: bring them there with gdalwarp");
  CHECK(grid.error(vrt("0, 10, 1, 0, 1, -10", "\"Int16\">")).find("gdalwarp") != std::string::npos);
  CHECK(grid.error(vrt(kPlace, "\"Float32\"><Scale>2</Scale>")).find("gdal_translate -unscale") !=
        std::string::npos);
  CHECK(grid.error(vrt(kPlace, "\"CFloat32\">")).find("type CFloat32") != std::string::npos);
  CHECK(grid.error(vrt(kPlace,
                       "\"Byte\"><Metadata domain=\"IMAGE_STRUCTURE\"><MDI key=\"PIXELTYPE\">"
                       "SIGNEDBYTE</MDI></Metadata>"))
            .find("signed bytes, which GDAL reads as unsigned: convert them") != std::string::npos);
  CHECK(grid.error("nonsense").find("t.vrt: GDAL cannot open it: ") == 0);
  CHECK(grid.session.failure("encode nosuch.tif -o new.mtin") ==
        "nosuch.tif: GDAL cannot open it: No such file or directory\n");
  grid.session.write("text.tif", "nonsense");
  // The words between are GDAL's own, and differ between its versions.
  const std::string error = grid.session.failure("encode text.tif -o new.mtin");
  CHECK(error.find("text.tif: GDAL cannot open it: not recognized as ") == 0);
  CHECK(contains(
      error, " supported file format. convert other formats with \"gdal_translate IN OUT.tif\"\n"));
}

TEST_CASE("gdal: a raster of more posts than its bytes can hold is refused before it is read") {
  const Session session;
  if (session.shell("command -v gdal_create").out.empty()) {
    MESSAGE("skipped: gdal_create is not installed");
    return;
  }
  const auto create = [&](const std::string& size, const std::string& more) {
    REQUIRE(session
                .shell("gdal_create -q -of GTiff -ot Float64 -a_srs EPSG:32633 -outsize " + size +
                       " -a_ullr 0 9 9 0 -co SPARSE_OK=TRUE " + more + " t.tif")
                .code == 0);
  };
  create("60000 60000", "");
  CHECK(contains(session.failure("encode t.tif -o new.mtin"),
                 " bytes cannot hold 60000 x 60000 posts: "));
  CHECK(contains(session.failure("encode t.tif --max-error 1 -o new.mtp"),
                 "gdal_translate -projwin"));
  create("40 30", "-co TILED=YES -co BLOCKXSIZE=65536 -co BLOCKYSIZE=65536");
  CHECK(contains(session.failure("encode t.tif -o new.mtin"), " bytes cannot hold 40 x 30 posts"));
  create("40 30", "");
  CHECK(session.run("encode t.tif -o new.mtin").code == 0);
}

TEST_CASE("gdal: skews that rounding leaves are none") {
  const Grid grid;
  CHECK(grid.read(vrt("500000, 10, 1e-18, 200, -1e-9, -10", "\"Int16\">")).x.offset == 500005);
  CHECK(contains(grid.error(vrt("500000, 10, 1e-6, 200, 0, -10", "\"Int16\">")), "gdalwarp"));
}

TEST_CASE("gdal: rows from south to north") {
  const Grid grid;
  const Raster raster = grid.read(vrt("500000, 10, 0, 180, 0, 10", "\"Int16\">"));
  CHECK(raster.heights == std::vector<int64_t>{1, 2, 3, 4, 5, 6});
  CHECK(raster.y.offset == 185);
}

TEST_CASE("gdal: a folder's .tif and .tiff files are one terrain") {
  const Session session;
  session.write("w.asc", "ncols 2\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 1\n1 2\n3 4\n");
  session.write("e.asc", "ncols 2\nnrows 2\nxllcenter 2\nyllcenter 0\ncellsize 1\n5 6\n7 8\n");
  REQUIRE(session
              .shell("mkdir cells && gdal_translate -q w.asc cells/w.tif && "
                     "gdal_translate -q -of GTiff e.asc cells/e.TIFF")
              .code == 0);
  const Session::Result encoded = session.run("encode cells --units metre -o t.mtin");
  CHECK(encoded.code == 0);
  CHECK(contains(encoded.out, "source: 8 posts, 2 files"));
  CHECK(!contains(encoded.err, "left out"));
}

TEST_CASE("gdal: masks make voids, one of several bands is chosen") {
  const Grid grid;
  const Session& session = grid.session;
  if (session.shell("command -v gdal_translate").out.empty()) {
    MESSAGE("skipped: gdal_translate is not installed");
    return;
  }
  session.write("m.asc",
                "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 10\n0 1 1\n1 1 0\n");
  REQUIRE(session
              .shell("gdal_translate -q -of GTiff t.asc t.tif && gdal_translate -q m.asc m.tif && "
                     "gdalbuildvrt -q -separate both.vrt t.tif m.tif && "
                     "gdal_translate -q -b 1 -mask 2 both.vrt masked.tif && "
                     "gdal_translate -q both.vrt both.tif")
              .code == 0);
  const auto heights = [&](const std::string& name, uint32_t band) {
    return std::get<Raster>(
               import_terrain(session.folder() + '/' + name, {}, Indirect::kRefused, band))
        .heights;
  };
  CHECK(heights("masked.tif", 0) == std::vector<int64_t>{4, 5, kVoidHeight, kVoidHeight, 2, 3});
  CHECK(heights("both.tif", 1) == std::vector<int64_t>{4, 5, 6, 1, 2, 3});
  CHECK(heights("both.tif", 2) == std::vector<int64_t>{1, 1, 0, 0, 1, 1});
  CHECK(contains(session.failure("encode both.tif -o new.mtin"),
                 "both.tif: has 2 bands: choose the band of heights by --band"));
  CHECK(contains(session.failure("encode both.tif --band 3 -o new.mtin"),
                 "both.tif: has no band 3; its last is 2"));
  CHECK(session.run("encode both.tif --band 2 -o new.mtin").code == 0);
  CHECK(session.run("verify new.mtin both.tif --band 2").code == 0);
}

TEST_CASE("gdal: voids that the file does not declare are refused or reported, with a remedy") {
  const Grid grid;
  const Session& session = grid.session;
  if (session.shell("command -v gdal_translate").out.empty()) {
    MESSAGE("skipped: gdal_translate is not installed");
    return;
  }
  const auto write = [&](const std::string& last) {  // 1, 2, 3 and another, in binary
    session.write("v.hdr",
                  "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 2\nbyteorder LSBFIRST\n");
    const char others[] = "\0\0\x80\x3F\0\0\0\x40\0\0\x40\x40";
    session.write("v.flt", std::string(others, sizeof others - 1) + last);
  };
  const std::pair<std::string, std::string> values[] = {
      {"-inf", {"\0\0\x80\xFF", 4}}, {"-3.4028234663852886e+38", "\xFF\xFF\x7F\xFF"}};
  for (const auto& [value, bytes] : values) {
    write(bytes);
    const std::string remedy = "gdal_translate -a_nodata " + value;
    const std::string error = session.failure("encode v.flt -o new.mtin");
    CHECK_MESSAGE(contains(error, "v.flt: row 1, column 1: " + value + " is not a height in range"),
                  error);
    CHECK(contains(error, remedy));
    REQUIRE(session.shell(remedy + " -q v.flt w.tif").code == 0);
    CHECK(contains(session.run("encode w.tif --units m -o w.mtin").out, "3 posts, 1 void posts"));
  }
  write({"\0\0\0\xC7", 4});
  CHECK(contains(session.run("encode v.flt --units m -o w.mtin").err,
                 "v.flt: taken as they are: 1 post of height -32768, far from all others"));
}

TEST_CASE("gdal: no-data values are compared in the type of the cells") {
  const Grid grid;
  const Session& session = grid.session;
  session.write("n.hdr",
                "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 2\nbyteorder LSBFIRST\n"
                "nodata_value -9999.99\n");
  session.write("n.flt", std::string("\0\0\x80\x3F\0\0\0\x40\0\0\x40\x40\xF6\x3F\x1C\xC6", 16));
  CHECK(std::get<Raster>(import_terrain(session.folder() + "/n.flt")).heights ==
        std::vector<int64_t>{3, kVoidHeight, 1, 2});
  const std::string band = "\"Float32\"><NoDataValue>-3.4e38</NoDataValue>";
  session.write("t.asc",
                "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n-3.40282346638529e+38 2 "
                "3\n4 5 6\n");
  CHECK(grid.read(vrt(kPlace, band)).heights == std::vector<int64_t>{4, 5, 6, kVoidHeight, 2, 3});
}

TEST_CASE("gdal: real files") {
  if (const std::string path = data_file("olinda_f32.tif"); !path.empty()) {
    const Raster raster = std::get<Raster>(import_terrain(path));
    CHECK(raster.heights.size() == 111 * 111);
  }
  if (const std::string path = data_file("rmnp_lzw_u16.tif"); !path.empty()) {
    const Raster raster = std::get<Raster>(import_terrain(path));
    CHECK(raster.x.numerator * 400 == raster.x.denominator * 11 / 10);
    CHECK(raster.reference.horizontal_epsg == 4326);
  }
}

TEST_CASE("gdal: files that name others are read only when allowed") {
  const Grid grid;
  grid.session.write("secret", "wxyz");
  grid.session.write("raw.vrt",
                     "<VRTDataset rasterXSize=\"2\" rasterYSize=\"2\"><GeoTransform>" + kPlace +
                         "</GeoTransform><VRTRasterBand band=\"1\" dataType=\"Byte\" "
                         "subClass=\"VRTRawRasterBand\"><SourceFilename relativeToVRT=\"1\">secret"
                         "</SourceFilename></VRTRasterBand></VRTDataset>");
  grid.session.write("raw.tif", grid.session.read("raw.vrt"));
  const std::string hint = "names other files, which are read only with --allow-vrt";
  CHECK(contains(grid.session.failure("encode raw.vrt -o new.mtin"), "raw.vrt: " + hint));
  CHECK(
      contains(grid.session.failure("encode raw.tif -o new.mtin"), "raw.tif: GDAL cannot open it"));
  for (const char* const name :
       {"/vsizip/raw.zip/raw.tif", "/vsistdin/", "GTIFF_DIR:1:/vsimem/x"}) {
    CHECK(contains(grid.session.failure("encode '" + std::string(name) + "' -o new.mtin"),
                   ": is a virtual file of GDAL's, which is read only with --allow-vrt"));
  }
  CHECK(grid.session.run("encode raw.vrt --allow-vrt -o secret.mtin").code == 0);
  CHECK(grid.session.run("verify secret.mtin raw.vrt --allow-vrt").code == 0);
  // It is an input as well as what it names.
  const Session::Result over = grid.session.run("encode raw.vrt --allow-vrt -o secret");
  CHECK(over.err == "microtin: secret: is also an input; choose another output\n");
  CHECK(grid.session.read("secret") == "wxyz");
}

TEST_CASE("gdal: drivers that read memory, the network or other files are not there") {
  const Grid grid;
  for (const char* const name :
       {"MEM:::DATAPOINTER=1,PIXELS=2,LINES=2", "vrt:///etc/passwd", "WMS:http://localhost/",
        "<VRTDataset/>", "HTTP://localhost/a.tif"}) {
    CHECK(contains(grid.session.failure("encode '" + std::string(name) + "' -o new.mtin"),
                   "GDAL cannot open it"));
  }
}

#endif
