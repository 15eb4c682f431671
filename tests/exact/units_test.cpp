// SPDX-License-Identifier: MIT
// Units of length against a list of their own: EPSG's registry 10.076, and what other programs
// write.
#include "encoder/exact/units.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <string>

#include "tests/support/layers.hpp"

using namespace microtin::tests;

namespace {

struct Row {
  uint32_t code;
  double metres;    // as the registry rounds it
  bool is_decimal;  // of a unit that streams have
};

// US survey units are decimals of their foot.
const std::map<std::string, Row>& rows() {
  static const std::map<std::string, Row> all = {
      {"millimetre", {1025, 0.001, true}},
      {"centimetre", {1033, 0.01, true}},
      {"decimetre", {0, 0.1, true}},
      {"hectometre", {0, 100, true}},
      {"kilometre", {9036, 1000, true}},
      {"nautical mile", {9030, 1852, true}},
      {"German legal metre", {9031, 1.0000135965, true}},
      {"inch", {0, 0.0254, true}},
      {"yard", {9096, 0.9144, true}},
      {"fathom", {9014, 1.8288, true}},
      {"chain", {9097, 20.1168, true}},
      {"link", {9098, 0.201168, true}},
      {"Statute mile", {9093, 1609.344, true}},
      {"US survey inch", {0, 0.0254000508001016, false}},
      {"US survey yard", {0, 0.914401828803658, true}},
      {"US survey chain", {9033, 20.1168402336805, true}},
      {"US survey link", {9034, 0.201168402336805, true}},
      {"US survey mile", {9035, 1609.34721869444, true}},
      {"Clarke's foot", {9005, 0.3047972654, true}},
      {"Clarke's yard", {9037, 0.9143917962, true}},
      {"Clarke's chain", {9038, 20.1166195164, true}},
      {"Clarke's link", {9039, 0.201166195164, true}},
      {"British yard (Sears 1922)", {9040, 0.914398414616029, false}},
      {"British foot (Sears 1922)", {9041, 0.304799471538676, false}},
      {"British chain (Sears 1922)", {9042, 20.1167651215526, false}},
      {"British link (Sears 1922)", {9043, 0.201167651215526, false}},
      {"British yard (Benoit 1895 A)", {9050, 0.9143992, true}},
      {"British foot (Benoit 1895 A)", {9051, 0.304799733333333, false}},
      {"British chain (Benoit 1895 A)", {9052, 20.1167824, true}},
      {"British link (Benoit 1895 A)", {9053, 0.201167824, true}},
      {"British yard (Benoit 1895 B)", {9060, 0.914399204289812, false}},
      {"British foot (Benoit 1895 B)", {9061, 0.304799734763271, false}},
      {"British chain (Benoit 1895 B)", {9062, 20.1167824943759, false}},
      {"British link (Benoit 1895 B)", {9063, 0.201167824943759, false}},
      {"British foot (1865)", {9070, 0.304800833333333, false}},
      {"Indian foot", {9080, 0.304799510248147, false}},
      {"Indian foot (1937)", {9081, 0.30479841, true}},
      {"Indian foot (1962)", {9082, 0.3047996, true}},
      {"Indian foot (1975)", {9083, 0.3047995, true}},
      {"Indian yard", {9084, 0.914398530744441, false}},
      {"Indian yard (1937)", {9085, 0.91439523, true}},
      {"Indian yard (1962)", {9086, 0.9143988, true}},
      {"Indian yard (1975)", {9087, 0.9143985, true}},
      {"Gold Coast foot", {9094, 0.304799710181509, false}},
      {"British foot (1936)", {9095, 0.3048007491, true}},
      {"British yard (Sears 1922 truncated)", {9099, 0.914398, true}},
      {"British foot (Sears 1922 truncated)", {9300, 0.304799333333333, false}},
      {"British chain (Sears 1922 truncated)", {9301, 20.116756, true}},
      {"British link (Sears 1922 truncated)", {9302, 0.20116756, true}}};
  return all;
}

double metres_of(const LengthUnit& length) {
  return *metres_per(length.base) * static_cast<double>(length.numerator) /
         static_cast<double>(length.denominator);
}

}  // namespace

TEST_CASE("units: every length of the table is the registry's, by its code, name and metres") {
  size_t checked = 0;
  for (const LengthUnit* length = begin_of_lengths(); length != end_of_lengths(); ++length) {
    const std::string name(length->name);
    CAPTURE(name);
    REQUIRE_MESSAGE(rows().count(name) == 1, "a unit without a row in this test");
    const Row& row = rows().at(name);
    ++checked;
    CHECK(length->code == row.code);
    CHECK(std::abs(metres_of(*length) / row.metres - 1) < 2e-15);
    CHECK(length_named(name) == length);
    CHECK(unit_named(name).other == name);
    CHECK(unit_of_length(row.metres, "?").other == name);
    if (row.code != 0) CHECK(unit_of_code(row.code).other == name);
    const auto factor = factor_of(*length);
    CHECK(factor.has_value() == row.is_decimal);
    if (!factor) continue;
    CHECK(static_cast<double>(factor->numerator) * std::pow(10, -factor->decimals) ==
          doctest::Approx(metres_of(*length) / *metres_per(length->base)).epsilon(1e-14));
  }
  CHECK(checked == rows().size());
}

TEST_CASE("units: those of streams by code, length and name") {
  struct Own {
    uint32_t code;
    double metres;
    Unit unit;
  };
  for (const auto& [code, metres, unit] :
       {Own{9001, 1, Unit::kMetre}, Own{9002, 0.3048, Unit::kFoot},
        Own{9003, 0.304800609601219, Unit::kUsSurveyFoot}}) {
    CHECK(unit_of_code(code).unit == unit);
    CHECK(unit_of_length(metres, "?").unit == unit);
    CHECK(unit_named(name_of(unit)).unit == unit);
    CHECK(std::abs(*metres_per(unit) / metres - 1) < 1e-14);
  }
  CHECK(unit_of_length(0.3048006, "?").unit == Unit::kUsSurveyFoot);
  CHECK(unit_of_code(9102).unit == Unit::kDegree);
  CHECK(unit_of_code(9122).unit == Unit::kDegree);
  CHECK(!unit_of_code(0).is_stated());
  CHECK(unit_of_code(7).other == "EPSG unit 7");
  CHECK(unit_of_length(0.5, "half").other == "half");
}

TEST_CASE("units: names as files and people write them") {
  const std::map<std::string, std::string> names = {{"m", "metre"},
                                                    {"Meters", "metre"},
                                                    {"METRES", "metre"},
                                                    {" mtr ", "metre"},
                                                    {"deg", "degree"},
                                                    {"Degrees", "degree"},
                                                    {"ft", "foot"},
                                                    {"Feet", "foot"},
                                                    {"International Foot", "foot"},
                                                    {"international feet", "foot"},
                                                    {"foot (international)", "foot"},
                                                    {"ft (intl)", "foot"},
                                                    {"us-ft", "US survey foot"},
                                                    {"us_ft", "US survey foot"},
                                                    {"us-foot", "US survey foot"},
                                                    {"us feet", "US survey foot"},
                                                    {"ft_us", "US survey foot"},
                                                    {"ftUS", "US survey foot"},
                                                    {"usft", "US survey foot"},
                                                    {"sft", "US survey foot"},
                                                    {"sfoot", "US survey foot"},
                                                    {"sfeet", "US survey foot"},
                                                    {"survey foot", "US survey foot"},
                                                    {"survey feet", "US survey foot"},
                                                    {"us_survey_foot", "US survey foot"},
                                                    {"US survey feet", "US survey foot"},
                                                    {"us survey ft", "US survey foot"},
                                                    {"Foot_US", "US survey foot"},
                                                    {"feet (us)", "US survey foot"},
                                                    {"foot (US survey)", "US survey foot"},
                                                    {"mm", "millimetre"},
                                                    {"millimeters", "millimetre"},
                                                    {"cm", "centimetre"},
                                                    {"Centimeter", "centimetre"},
                                                    {"dm", "decimetre"},
                                                    {"decimeter", "decimetre"},
                                                    {"hm", "hectometre"},
                                                    {"hectometer", "hectometre"},
                                                    {"km", "kilometre"},
                                                    {"Kilometers", "kilometre"},
                                                    {"nmi", "nautical mile"},
                                                    {"kmi", "nautical mile"},
                                                    {"in", "inch"},
                                                    {"inches", "inch"},
                                                    {"yd", "yard"},
                                                    {"Yards", "yard"},
                                                    {"fath", "fathom"},
                                                    {"fm", "fathom"},
                                                    {"ftm", "fathom"},
                                                    {"fathoms", "fathom"},
                                                    {"ch", "chain"},
                                                    {"chains", "chain"},
                                                    {"li", "link"},
                                                    {"lk", "link"},
                                                    {"links", "link"},
                                                    {"mi", "Statute mile"},
                                                    {"mile", "Statute mile"},
                                                    {"miles", "Statute mile"},
                                                    {"us-in", "US survey inch"},
                                                    {"us-yd", "US survey yard"},
                                                    {"us yard", "US survey yard"},
                                                    {"us-ch", "US survey chain"},
                                                    {"us chain", "US survey chain"},
                                                    {"us link", "US survey link"},
                                                    {"us-mi", "US survey mile"},
                                                    {"us mile", "US survey mile"},
                                                    {"ind-ft", "Indian foot"},
                                                    {"ind-yd", "Indian yard"},
                                                    {"Foot_Gold_Coast", "Gold Coast foot"},
                                                    {"Foot_Clarke", "Clarke's foot"},
                                                    {"Yard_Clarke", "Clarke's yard"},
                                                    {"Link_Clarke", "Clarke's link"}};
  for (const auto& row : names) {
    const auto& text = row.first;
    const auto& name = row.second;
    const StatedUnit unit = unit_named(text);
    CHECK_MESSAGE((unit.other.empty() ? std::string(name_of(unit.unit)) : unit.other) == name,
                  text);
  }
  for (const char* const other :
       {"ms", "furlong", "ins", "1", "m/s", "dB", "\xC2\xB5m", "\xCE\xBCm", "k\xC3\xA4m"}) {
    CHECK_MESSAGE(unit_named(other).other == other, other);
  }
  CHECK(!unit_named("").is_stated());
  CHECK(!unit_named("unknown").is_stated());
}
