// SPDX-License-Identifier: MIT
#include "encoder/export/system.hpp"

#include <doctest/doctest.h>

#include <locale>

#include "tests/support/layers.hpp"

namespace microtin::tests {
namespace {

struct Comma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
};

}  // namespace

TEST_CASE("systems: the unit of heights follows the system, whatever the program's locale") {
  const std::string horizontal = "LOCAL_CS[\"a\",UNIT[\"Meter\",1.0]]";
  Metadata metadata;
  metadata.wkt = horizontal;
  CHECK(system_text(metadata) == horizontal + "\n");

  metadata.vertical_unit = Unit::kUsSurveyFoot;
  const std::locale before = std::locale::global(std::locale(std::locale(), new Comma));
  const std::string text = system_text(metadata);
  std::locale::global(before);
  CHECK(text.find(horizontal + ",VERTCS[") == 0);
  CHECK(text.find(",UNIT[\"Foot_US\",0.3048006096012192]]\n") != text.npos);
}

TEST_CASE("systems: each unit of heights has its name and length with any unit of positions") {
  struct Case {
    Unit unit;
    std::string text;
  };
  for (const std::string horizontal :
       {"LOCAL_CS[\"a\",UNIT[\"Meter\",1.0]]", "LOCAL_CS[\"a\",UNIT[\"Foot\",0.3048]]"}) {
    for (const auto& [unit, text] :
         {Case{Unit::kMetre, "UNIT[\"Meter\",1.0]"}, Case{Unit::kFoot, "UNIT[\"Foot\",0.3048]"},
          Case{Unit::kUsSurveyFoot, "UNIT[\"Foot_US\",0.3048006096"}}) {
      Metadata metadata;
      metadata.wkt = horizontal;
      metadata.vertical_unit = unit;
      const std::string all = system_text(metadata);
      CHECK(all.find(horizontal + ",VERTCS[") == 0);
      CHECK(all.find(text, horizontal.size()) != all.npos);
    }
  }
}

}  // namespace microtin::tests
