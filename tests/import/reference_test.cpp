// SPDX-License-Identifier: MIT
// What files, codes and options say of units and directions, made one.
#include "encoder/import/reference.hpp"

#include <doctest/doctest.h>

#include <string>

#include "encoder/import/crs.hpp"
#include "tests/support/imports.hpp"

using namespace microtin::tests;

namespace {

const std::string kPlane = R"(PROJCS["p",UNIT["Meter",1.0]])";

std::string compound(const std::string& vertical) {
  return "COMPD_CS[\"c\"," + kPlane + "," + vertical + "]";
}

Reference asking(const std::string& units, bool depths = false) {
  Reference asked;
  CHECK((units.empty() || read_units(units, asked)));
  asked.depths = depths;
  return asked;
}

std::string told(const Reference& reference) {
  std::string all;
  for (const std::string& warning : reference.warnings) all += warning + "|";
  return all;
}

Source heights(const Reference& reference) {
  PointCloud cloud;
  cloud.points = {{10, 20, 100}, {30, 40, -5}};
  cloud.xy_decimals = 1;
  cloud.reference = reference;
  return cloud;
}

std::string settled_text(Source source, const Reference& asked) {
  settle_source(source, asked);
  const auto& cloud = std::get<PointCloud>(source);
  return text_of(cloud) + " / " + std::to_string(cloud.xy_decimals) + " " +
         std::to_string(cloud.z_decimals) + " " +
         std::string(name_of(cloud.reference.vertical_unit));
}

}  // namespace

TEST_CASE("reference: units of heights in well-known text are converted exactly, or refused") {
  const auto text = [](const std::string& unit) {
    return settled_text(heights(reference_of_wkt(compound("VERT_CS[\"v\",UNIT[" + unit + "]]"))),
                        {});
  };
  CHECK(text(R"("metre",1)") == "10,20,100 30,40,-5 / 1 0 metre");
  CHECK(text(R"("foot",0.3048)") == "10,20,100 30,40,-5 / 1 0 foot");
  CHECK(text(R"("centimetre",0.01)") == "10,20,100 30,40,-5 / 1 2 metre");
  CHECK(text(R"("kilometre",1000)") == "10,20,100000 30,40,-5000 / 1 0 metre");
  CHECK(text(R"("fathom",1.8288)") == "10,20,1828800 30,40,-91440 / 1 4 metre");
  CHECK(text(R"("US survey chain",20.1168402336805)") ==
        "10,20,6600 30,40,-330 / 1 0 US survey foot");
  CHECK(text(R"("Clarke's foot",0.3047972654)") ==
        "10,20,304797265400 30,40,-15239863270 / 1 10 metre");
  CHECK(import_error([&] { text(R"x("British foot (Sears 1922)",0.304799471538676)x"); }) ==
        "the unit of heights is British foot (Sears 1922), 12000000/39370147 metre, which no "
        "decimal is exactly: convert them, or set units");
  CHECK(import_error([&] { text(R"("span",0.2286)"); }) ==
        "the unit of heights is \"span\", which is not known: convert them, or set units");
}

TEST_CASE("reference: an option decides the unit, and a warning names what it overrides") {
  const Reference file = reference_of_wkt(compound(R"(VERT_CS["v",UNIT["span",0.2286]])"));
  const SettledReference settled = settle(file, asking(":cm"));
  CHECK(settled.reference.vertical_unit == Unit::kMetre);
  CHECK(settled.conversion.z.decimals == 2);
  CHECK(told(settled.reference) ==
        "heights are taken as centimetre; the file says span|heights in the unit centimetre are "
        "converted to metre: times 0.01|");
  CHECK(settled.reference.wkt == kPlane);  // the rest says another unit
  CHECK(told(settle(file, asking(":metre")).reference) ==
        "heights are taken as metre; the file says span|");
  Reference coded = asking(":cm");
  coded.vertical_epsg = 5703;
  CHECK(settle(file, coded).reference.vertical_epsg == 5703);
  coded.vertical_epsg = 6360;
  CHECK(told(settle({}, coded).reference) ==
        "heights in the unit centimetre are converted to metre: times 0.01|EPSG 6360 has another "
        "unit, and is not noted|");
  coded = asking(":foot");
  coded.vertical_epsg = 5703;
  CHECK(import_error([&] { settle({}, coded); }) == "EPSG 5703 has the unit metre, not foot");
}

TEST_CASE(
    "reference: one unit that is asked for is that of heights, too, unless a code says another") {
  Reference file;
  file.horizontal_unit = Unit::kMetre;
  file.vertical_unit = Unit::kFoot;
  const Reference one = settle(file, asking("metre")).reference;
  CHECK(one.vertical_unit == Unit::kMetre);
  CHECK(told(one) == "heights are taken as metre; the file says foot|");
  Reference coded = asking("metre");
  coded.vertical_epsg = 6360;
  CHECK(settle({}, coded).reference.vertical_unit == Unit::kUsSurveyFoot);
  CHECK(settle(file, asking("degree")).reference.vertical_unit == Unit::kFoot);
}

TEST_CASE("reference: units of positions are converted if no system states them") {
  CHECK(settled_text(heights({}), asking("km:m")) == "1000,2000,100 3000,4000,-5 / 0 0 metre");
  Reference system;
  system.horizontal_epsg = 32633;
  system.horizontal_unit = Unit::kMetre;
  CHECK(settle(system, asking("km:m")).conversion.xy.decimals == -3);
  CHECK(
      import_error([&] { settle(reference_of_wkt(R"(PROJCS["p",UNIT["link",0.201168]])"), {}); }) ==
      "the unit of x and y is link, and their system has no other: bring them into a system of "
      "metres or feet with gdalwarp -t_srs, or set units");
  system.horizontal_epsg = 4326;
  system.horizontal_unit = Unit::kDegree;
  CHECK(import_error([&] { settle(system, asking("km:m")); }) ==
        "EPSG 4326 has the unit degree, not metre");
}

TEST_CASE("reference: depths are refused, or turned into heights, by whatever says them") {
  struct Case {
    std::string vertical;
    uint32_t heights;  // code afterwards
  };
  for (const auto& row :
       {Case{R"(VERT_CS["MSL depth",UNIT["metre",1],AXIS["Depth",DOWN],AUTHORITY["EPSG","5715"]])",
             5714},
        Case{R"(VERT_CS["local",UNIT["metre",1],AXIS["Depth",DOWN]])", 0},
        Case{R"(VERTCS["v",VDATUM["d"],PARAMETER["Direction",-1.0],UNIT["Meter",1.0]])", 0},
        Case{R"(VERTCS["EGM96_Geoid",PARAMETER["Direction",-1.0],UNIT["Meter",1.0]])", 5773},
        Case{R"x(VERTCRS["d",CS[vertical,1],AXIS["depth (D)",down,LENGTHUNIT["metre",1]]])x", 0},
        Case{R"x(VERTCRS["d",CS[vertical,1],AXIS["depth (D)",down,LENGTHUNIT["metre",1]],)x"
             R"(ID["EPSG",5861]])",
             0}}) {
    const std::string& vertical = row.vertical;
    const uint32_t code = row.heights;
    CAPTURE(vertical);
    const Reference file = reference_of_wkt(compound(vertical));
    CHECK(import_error([&] { settle(file, {}); }).find("negate them with depths") !=
          std::string::npos);
    CHECK(settled_text(heights(file), asking("", true)) == "10,20,-100 30,40,5 / 1 0 metre");
    const Reference turned = settle(file, asking("", true)).reference;
    CHECK(turned.vertical_epsg == code);
    CHECK(turned.wkt == kPlane);
    CHECK(told(turned).find("depths are turned into heights") == 0);
    CHECK(!turned.depths);
    Reference decides;
    decides.vertical_epsg = 5714;
    CHECK(settle(file, decides).conversion.z.numerator == 1);
    CHECK(told(settle(file, decides).reference).find("the file says") != std::string::npos);
  }
  Reference asked = asking("", true);
  asked.vertical_epsg = 5715;
  CHECK(settle({}, asked).reference.vertical_epsg == 5714);
  asked.depths = false;
  CHECK(import_error([&] { settle({}, asked); }).find("heights are depths (EPSG 5715)") == 0);
  Reference file;
  file.vertical_epsg = 5773;
  CHECK(told(settle(file, asking("", true)).reference) ==
        "depths are turned into heights; the file says heights (EPSG 5773)|");
}

TEST_CASE("reference: every depth of the table of codes is refused, and turned") {
  for (const VerticalCode* code = begin_of_verticals(); code != end_of_verticals(); ++code) {
    CAPTURE(code->code);
    Reference file;
    file.vertical_epsg = code->code;
    const bool is_refused = import_error([&] { settle(file, {}); }) != "none";
    CHECK(is_refused == code->is_depth);
    if (code->is_depth) CHECK(settle(file, asking("", true)).conversion.z.numerator == -1);
  }
}

TEST_CASE("reference: heights get the unit of x and y, with a warning if that is a foot") {
  const auto guessed = [](Unit unit) {
    Reference reference;
    reference.horizontal_unit = unit;
    return completed(reference);
  };
  CHECK(guessed(Unit::kMetre).vertical_unit == Unit::kMetre);
  CHECK(guessed(Unit::kMetre).warnings.empty());
  for (const Unit unit : {Unit::kFoot, Unit::kUsSurveyFoot}) {
    CHECK(guessed(unit).vertical_unit == unit);
    CHECK(told(guessed(unit)).find("heights are taken as") == 0);
  }
  CHECK(told(guessed(Unit::kUnknown)).find("the unit of x and y is not known") == 0);
}

TEST_CASE("reference: numbers with too many digits are refused, not rounded") {
  PointCloud cloud;
  cloud.points = {{0, 0, 999999999999999999}};
  Source source = cloud;
  CHECK(import_error([&] { settle_source(source, asking(":km")); }).find("too many digits") !=
        std::string::npos);
  cloud.z_decimals = 9;
  cloud.points = {{0, 0, 1}};
  source = cloud;
  CHECK(import_error([&] {
          settle_source(source, asking(":Clarke's foot"));
        }).find("too many digits") != std::string::npos);
}

TEST_CASE("reference: rasters are converted whole and in pieces alike") {
  Raster raster;
  raster.width = 2;
  raster.height = 1;
  raster.heights = {kVoidHeight, 250};
  raster.x = {1, 2, 1};
  raster.y = {3, 4, 1};
  Source whole = raster;
  OpenSource open = std::make_unique<RasterInMemory>(raster);
  const Reference asked = asking("km:cm", true);
  settle_source(whole, asked);
  settle_source(open, asked);
  const Raster piece = std::get<std::unique_ptr<RasterReader>>(open)->read({0, 0, 2, 1});
  const Raster& all = std::get<Raster>(whole);
  for (const Raster* const one : {&all, &piece}) {
    CHECK(one->heights == std::vector<int64_t>{kVoidHeight, -250});
    CHECK(one->decimals == 2);
    CHECK(one->x.offset == 1000);
    CHECK(one->x.numerator == 2000);
    CHECK(one->y.offset == 3000);
    CHECK(one->reference.horizontal_unit == Unit::kMetre);
  }
}
