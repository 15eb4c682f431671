// SPDX-License-Identifier: MIT
// Tables of units.
#include "encoder/exact/units.hpp"

#include <array>
#include <cmath>
#include <string>

#include "encoder/base/suffix.hpp"

namespace microtin::exact {
namespace {

struct Name {
  std::string_view text;
  Unit unit;
};

constexpr std::array<Name, 19> kNames = {{{"m", Unit::kMetre},
                                          {"metre", Unit::kMetre},
                                          {"metres", Unit::kMetre},
                                          {"meter", Unit::kMetre},
                                          {"meters", Unit::kMetre},
                                          {"deg", Unit::kDegree},
                                          {"degree", Unit::kDegree},
                                          {"degrees", Unit::kDegree},
                                          {"ft", Unit::kFoot},
                                          {"foot", Unit::kFoot},
                                          {"feet", Unit::kFoot},
                                          {"international foot", Unit::kFoot},
                                          {"us-ft", Unit::kUsSurveyFoot},
                                          {"us-foot", Unit::kUsSurveyFoot},
                                          {"ftus", Unit::kUsSurveyFoot},
                                          {"us_survey_foot", Unit::kUsSurveyFoot},
                                          {"us survey foot", Unit::kUsSurveyFoot},
                                          {"us survey feet", Unit::kUsSurveyFoot},
                                          {"foot_us", Unit::kUsSurveyFoot}}};

constexpr std::array<Unit, 3> kLengths = {Unit::kMetre, Unit::kFoot, Unit::kUsSurveyFoot};

}  // namespace

std::string_view name_of(Unit unit) {
  switch (unit) {
    case Unit::kMetre:
      return "metre";
    case Unit::kDegree:
      return "degree";
    case Unit::kFoot:
      return "foot";
    case Unit::kUsSurveyFoot:
      return "US survey foot";
    case Unit::kUnknown:
      break;
  }
  return "unknown";
}

std::string_view symbol_of(Unit unit) {
  switch (unit) {
    case Unit::kMetre:
      return "m";
    case Unit::kFoot:
    case Unit::kUsSurveyFoot:
      return "ft";
    case Unit::kDegree:
    case Unit::kUnknown:
      break;
  }
  return "";
}

std::optional<Unit> unit_named(std::string_view name) {
  const std::string lower = lower_case(std::string(name));
  for (const Name& known : kNames) {
    if (known.text == lower) return known.unit;
  }
  return std::nullopt;
}

std::optional<double> metres_per(Unit unit) {
  switch (unit) {
    case Unit::kMetre:
      return 1;
    case Unit::kFoot:
      return 0.3048;
    case Unit::kUsSurveyFoot:
      return 1200.0 / 3937;
    case Unit::kDegree:
    case Unit::kUnknown:
      break;
  }
  return std::nullopt;
}

Unit unit_of_metres(double metres) {
  for (const Unit unit : kLengths) {
    if (std::abs(metres - *metres_per(unit)) < 1e-7) return unit;
  }
  return Unit::kUnknown;
}

}  // namespace microtin::exact
