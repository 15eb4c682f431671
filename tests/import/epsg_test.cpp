// SPDX-License-Identifier: MIT
// Codes that are known without PROJ, against a list of their own: EPSG's registry 10.076.
#include <doctest/doctest.h>

#include <map>
#include <string>

#include "encoder/import/crs.hpp"
#include "tests/support/layers.hpp"

using namespace microtin::tests;

namespace {

struct Row {
  std::string name;
  Unit unit;
  bool is_depth;
  uint32_t heights;  // of the same datum and unit, upwards
};

const std::map<uint32_t, Row> kRows = {
    {3855, {"EGM2008 height", Unit::kMetre, false, 0}},
    {5336, {"Black Sea depth", Unit::kMetre, true, 5735}},
    {5612, {"Baltic 1977 depth", Unit::kMetre, true, 5705}},
    {5614, {"KOC WD depth (ft)", Unit::kFoot, true, 0}},
    {5621, {"EVRF2007 height", Unit::kMetre, false, 0}},
    {5701, {"ODN height", Unit::kMetre, false, 0}},
    {5702, {"NGVD29 height (ftUS)", Unit::kUsSurveyFoot, false, 0}},
    {5703, {"NAVD88 height", Unit::kMetre, false, 0}},
    {5705, {"Baltic 1977 height", Unit::kMetre, false, 0}},
    {5706, {"Caspian depth", Unit::kMetre, true, 5611}},
    {5709, {"NAP height", Unit::kMetre, false, 0}},
    {5711, {"AHD height", Unit::kMetre, false, 0}},
    {5713, {"CGVD28 height", Unit::kMetre, false, 0}},
    {5714, {"MSL height", Unit::kMetre, false, 0}},
    {5715, {"MSL depth", Unit::kMetre, true, 5714}},
    {5720, {"NGF-IGN69 height", Unit::kMetre, false, 0}},
    {5728, {"LN02 height", Unit::kMetre, false, 0}},
    {5729, {"LHN95 height", Unit::kMetre, false, 0}},
    {5730, {"EVRF2000 height", Unit::kMetre, false, 0}},
    {5734, {"AIOC95 depth", Unit::kMetre, true, 5797}},
    {5739, {"HKCD depth", Unit::kMetre, true, 0}},
    {5773, {"EGM96 height", Unit::kMetre, false, 0}},
    {5783, {"DHHN92 height", Unit::kMetre, false, 0}},
    {5789, {"KOC WD depth", Unit::kMetre, true, 7979}},
    {5798, {"EGM84 height", Unit::kMetre, false, 0}},
    {5831, {"Instantaneous Water Level depth", Unit::kMetre, true, 5829}},
    {5861, {"LAT depth", Unit::kMetre, true, 0}},
    {5862, {"LLWLT depth", Unit::kMetre, true, 0}},
    {5863, {"ISLW depth", Unit::kMetre, true, 0}},
    {5864, {"MLLWS depth", Unit::kMetre, true, 0}},
    {5865, {"MLWS depth", Unit::kMetre, true, 0}},
    {5866, {"MLLW depth", Unit::kMetre, true, 0}},
    {5867, {"MLW depth", Unit::kMetre, true, 0}},
    {5873, {"Low Water depth", Unit::kMetre, true, 0}},
    {6130, {"GCVD54 height (ft)", Unit::kFoot, false, 0}},
    {6131, {"LCVD61 height (ft)", Unit::kFoot, false, 0}},
    {6132, {"CBVD61 height (ft)", Unit::kFoot, false, 0}},
    {6357, {"NAVD88 depth", Unit::kMetre, true, 5703}},
    {6358, {"NAVD88 depth (ftUS)", Unit::kUsSurveyFoot, true, 6360}},
    {6359, {"NGVD29 depth (ftUS)", Unit::kUsSurveyFoot, true, 5702}},
    {6360, {"NAVD88 height (ftUS)", Unit::kUsSurveyFoot, false, 0}},
    {6647, {"CGVD2013(CGG2013) height", Unit::kMetre, false, 0}},
    {6695, {"JGD2011 (vertical) height", Unit::kMetre, false, 0}},
    {7837, {"DHHN2016 height", Unit::kMetre, false, 0}},
    {7839, {"NZVD2016 height", Unit::kMetre, false, 0}},
    {7976, {"HKPD depth", Unit::kMetre, true, 5738}},
    {8050, {"MSL height (ft)", Unit::kFoot, false, 0}},
    {8051, {"MSL depth (ft)", Unit::kFoot, true, 8050}},
    {8052, {"MSL height (ftUS)", Unit::kUsSurveyFoot, false, 0}},
    {8053, {"MSL depth (ftUS)", Unit::kUsSurveyFoot, true, 8052}},
    {8228, {"NAVD88 height (ft)", Unit::kFoot, false, 0}},
    {8358, {"Baltic 1957 depth", Unit::kMetre, true, 8357}},
    {8378, {"EPSG example wellbore local vertical CRS", Unit::kMetre, true, 0}},
    {8897, {"EPSG example wellbore local vertical CRS (ft)", Unit::kFoot, true, 0}},
    {9287, {"LAT NL depth", Unit::kMetre, true, 0}},
    {9288, {"MSL NL depth", Unit::kMetre, true, 0}},
    {9389, {"EVRF2019 height", Unit::kMetre, false, 0}},
    {9672, {"CD Norway depth", Unit::kMetre, true, 0}}};
}  // namespace

TEST_CASE("epsg: every vertical system of the table is the registry's") {
  size_t checked = 0;
  for (const VerticalCode* code = begin_of_verticals(); code != end_of_verticals(); ++code) {
    CAPTURE(code->code);
    REQUIRE_MESSAGE(kRows.count(code->code) == 1, "a code without a row in this test");
    const Row& row = kRows.at(code->code);
    CAPTURE(row.name);
    ++checked;
    const std::optional<CodedSystem> system = built_in_system(code->code);
    REQUIRE(system);
    CHECK(system->is_vertical);
    CHECK(system->unit == row.unit);
    CHECK(system->other.empty());
    CHECK(system->is_depth == row.is_depth);
    CHECK(system->heights == row.heights);
    CHECK(system->is_depth == (row.name.find("depth") != std::string::npos ||
                               row.name.find("wellbore") != std::string::npos));
#ifdef MICROTIN_WITH_GDAL
    const std::optional<CodedSystem> known = system_by_proj(code->code);
    REQUIRE(known);
    CHECK(known->unit == row.unit);
    CHECK(known->is_depth == row.is_depth);
#endif
  }
  CHECK(checked == kRows.size());
}

TEST_CASE("epsg: every horizontal system of the table, and no other") {
  const auto expected = [](uint32_t code) {
    if (code == 4326 || code == 4258 || code == 4269) return Unit::kDegree;
    const bool is_zone = (code >= 32601 && code <= 32660) || (code >= 32701 && code <= 32760) ||
                         (code >= 25828 && code <= 25838) || (code >= 26901 && code <= 26923);
    return code == 3857 || is_zone ? Unit::kMetre : Unit::kUnknown;
  };
  for (uint32_t code = 0; code < 70000; ++code) {
    const std::optional<CodedSystem> system = built_in_system(code);
    const bool is_horizontal = system && !system->is_vertical;
    CHECK_MESSAGE(is_horizontal == (expected(code) != Unit::kUnknown), code);
    if (is_horizontal) CHECK_MESSAGE(system->unit == expected(code), code);
  }
}
