// SPDX-License-Identifier: MIT
// Tables of units.
#include "encoder/exact/units.hpp"

#include <array>
#include <cmath>
#include <string>

#include "encoder/base/text.hpp"

namespace microtin::exact {
namespace {

struct Name {
  std::string_view text;  // lower case; one blank for all that is no letter
  std::string_view unit;  // of kUnits or kLengths
};

struct KnownUnit {
  uint32_t code;
  std::string_view name;
  Unit unit;
};

constexpr std::array<KnownUnit, 5> kUnits = {
    {{9001, "metre", Unit::kMetre},
     {9102, "degree", Unit::kDegree},
     {9122, "degree (supplier to define representation)", Unit::kDegree},
     {9002, "foot", Unit::kFoot},
     {9003, "US survey foot", Unit::kUsSurveyFoot}}};

constexpr int64_t kTen7 = 10000000, kTen8 = 100000000, kTen10 = 10000000000, kTen12 = 1000000000000;

// Ratios to the metre; US survey units count US survey feet, which no decimal of metres equals.
constexpr std::array<LengthUnit, 49> kLengths = {
    {{1025, "millimetre", Unit::kMetre, 1, 1000},
     {1033, "centimetre", Unit::kMetre, 1, 100},
     {0, "decimetre", Unit::kMetre, 1, 10},
     {0, "hectometre", Unit::kMetre, 100, 1},
     {9036, "kilometre", Unit::kMetre, 1000, 1},
     {9030, "nautical mile", Unit::kMetre, 1852, 1},
     {9031, "German legal metre", Unit::kMetre, 10000135965, kTen10},
     {0, "inch", Unit::kMetre, 254, 10000},
     {9096, "yard", Unit::kMetre, 9144, 10000},
     {9014, "fathom", Unit::kMetre, 18288, 10000},
     {9097, "chain", Unit::kMetre, 201168, 10000},
     {9098, "link", Unit::kMetre, 201168, 1000000},
     {9093, "Statute mile", Unit::kMetre, 1609344, 1000},
     {0, "US survey inch", Unit::kUsSurveyFoot, 1, 12},
     {0, "US survey yard", Unit::kUsSurveyFoot, 3, 1},
     {9033, "US survey chain", Unit::kUsSurveyFoot, 66, 1},
     {9034, "US survey link", Unit::kUsSurveyFoot, 66, 100},
     {9035, "US survey mile", Unit::kUsSurveyFoot, 5280, 1},
     {9005, "Clarke's foot", Unit::kMetre, 3047972654, kTen10},
     {9037, "Clarke's yard", Unit::kMetre, 9143917962, kTen10},
     {9038, "Clarke's chain", Unit::kMetre, 201166195164, kTen10},
     {9039, "Clarke's link", Unit::kMetre, 201166195164, kTen12},
     {9040, "British yard (Sears 1922)", Unit::kMetre, 36000000, 39370147},
     {9041, "British foot (Sears 1922)", Unit::kMetre, 12000000, 39370147},
     {9042, "British chain (Sears 1922)", Unit::kMetre, 792000000, 39370147},
     {9043, "British link (Sears 1922)", Unit::kMetre, 7920000, 39370147},
     {9050, "British yard (Benoit 1895 A)", Unit::kMetre, 9143992, kTen7},
     {9051, "British foot (Benoit 1895 A)", Unit::kMetre, 9143992, 3 * kTen7},
     {9052, "British chain (Benoit 1895 A)", Unit::kMetre, 201167824, kTen7},
     {9053, "British link (Benoit 1895 A)", Unit::kMetre, 201167824, 100 * kTen7},
     {9060, "British yard (Benoit 1895 B)", Unit::kMetre, 36000000, 39370113},
     {9061, "British foot (Benoit 1895 B)", Unit::kMetre, 12000000, 39370113},
     {9062, "British chain (Benoit 1895 B)", Unit::kMetre, 792000000, 39370113},
     {9063, "British link (Benoit 1895 B)", Unit::kMetre, 7920000, 39370113},
     {9070, "British foot (1865)", Unit::kMetre, 9144025, 3 * kTen7},
     {9080, "Indian foot", Unit::kMetre, 12000000, 39370142},
     {9081, "Indian foot (1937)", Unit::kMetre, 30479841, kTen8},
     {9082, "Indian foot (1962)", Unit::kMetre, 3047996, kTen7},
     {9083, "Indian foot (1975)", Unit::kMetre, 3047995, kTen7},
     {9084, "Indian yard", Unit::kMetre, 36000000, 39370142},
     {9085, "Indian yard (1937)", Unit::kMetre, 91439523, kTen8},
     {9086, "Indian yard (1962)", Unit::kMetre, 9143988, kTen7},
     {9087, "Indian yard (1975)", Unit::kMetre, 9143985, kTen7},
     {9094, "Gold Coast foot", Unit::kMetre, 6378300, 20926201},
     {9095, "British foot (1936)", Unit::kMetre, 3048007491, kTen10},
     {9099, "British yard (Sears 1922 truncated)", Unit::kMetre, 914398, 1000000},
     {9300, "British foot (Sears 1922 truncated)", Unit::kMetre, 914398, 3000000},
     {9301, "British chain (Sears 1922 truncated)", Unit::kMetre, 20116756, 1000000},
     {9302, "British link (Sears 1922 truncated)", Unit::kMetre, 20116756, kTen8}}};

// Names that the tables above do not have.
constexpr std::array<Name, 63> kNames = {{{"m", "metre"},
                                          {"meter", "metre"},
                                          {"mtr", "metre"},
                                          {"deg", "degree"},
                                          {"ft", "foot"},
                                          {"feet", "foot"},
                                          {"international foot", "foot"},
                                          {"international feet", "foot"},
                                          {"foot international", "foot"},
                                          {"ft intl", "foot"},
                                          {"us ft", "US survey foot"},
                                          {"us foot", "US survey foot"},
                                          {"us feet", "US survey foot"},
                                          {"ft us", "US survey foot"},
                                          {"ftus", "US survey foot"},
                                          {"usft", "US survey foot"},
                                          {"sft", "US survey foot"},
                                          {"sfoot", "US survey foot"},
                                          {"sfeet", "US survey foot"},
                                          {"survey foot", "US survey foot"},
                                          {"survey feet", "US survey foot"},
                                          {"us survey feet", "US survey foot"},
                                          {"us survey ft", "US survey foot"},
                                          {"foot us", "US survey foot"},
                                          {"feet us", "US survey foot"},
                                          {"foot us survey", "US survey foot"},
                                          {"mm", "millimetre"},
                                          {"millimeter", "millimetre"},
                                          {"cm", "centimetre"},
                                          {"centimeter", "centimetre"},
                                          {"dm", "decimetre"},
                                          {"decimeter", "decimetre"},
                                          {"hm", "hectometre"},
                                          {"hectometer", "hectometre"},
                                          {"km", "kilometre"},
                                          {"kilometer", "kilometre"},
                                          {"nmi", "nautical mile"},
                                          {"kmi", "nautical mile"},
                                          {"in", "inch"},
                                          {"inches", "inch"},
                                          {"yd", "yard"},
                                          {"fath", "fathom"},
                                          {"fm", "fathom"},
                                          {"ftm", "fathom"},
                                          {"ch", "chain"},
                                          {"li", "link"},
                                          {"lk", "link"},
                                          {"mi", "Statute mile"},
                                          {"mile", "Statute mile"},
                                          {"us in", "US survey inch"},
                                          {"us yd", "US survey yard"},
                                          {"us yard", "US survey yard"},
                                          {"us ch", "US survey chain"},
                                          {"us chain", "US survey chain"},
                                          {"us link", "US survey link"},
                                          {"us mi", "US survey mile"},
                                          {"us mile", "US survey mile"},
                                          {"ind ft", "Indian foot"},
                                          {"ind yd", "Indian yard"},
                                          {"foot gold coast", "Gold Coast foot"},
                                          {"foot clarke", "Clarke's foot"},
                                          {"yard clarke", "Clarke's yard"},
                                          {"link clarke", "Clarke's link"}}};

constexpr std::array<Unit, 3> kMeasures = {Unit::kMetre, Unit::kFoot, Unit::kUsSurveyFoot};

// Letters beyond ASCII count, too: a micrometre is not a metre.
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || static_cast<unsigned char>(c) >= 0x80;
}

// In lower case, with one blank for all between words.
std::string plain(std::string_view text) {
  std::string words;
  for (const char c : lower_case(std::string(text))) {
    if (is_letter(c)) {
      words += c;
    } else if (c != '\'' && !words.empty() && words.back() != ' ') {
      words += ' ';
    }
  }
  if (!words.empty() && words.back() == ' ') words.pop_back();
  return words;
}

// By one of the tables' names, or by a short one.
StatedUnit known_unit(const std::string& words) {
  for (const KnownUnit& known : kUnits) {
    if (plain(known.name) == words) return {known.unit, {}};
  }
  for (const LengthUnit& length : kLengths) {
    if (plain(length.name) == words) return {Unit::kUnknown, std::string(length.name)};
  }
  for (const Name& name : kNames) {
    if (name.text == words) return known_unit(plain(name.unit));
  }
  return {};
}

double metres_of(const LengthUnit& length) {
  return *metres_per(length.base) * static_cast<double>(length.numerator) /
         static_cast<double>(length.denominator);
}

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

const LengthUnit* begin_of_lengths() {
  return kLengths.data();
}

const LengthUnit* end_of_lengths() {
  return kLengths.data() + kLengths.size();
}

StatedUnit unit_named(std::string_view text) {
  constexpr size_t kShortest = 4;  // of a plural: ms are no metres
  std::string words = plain(text);
  if (words == name_of(Unit::kUnknown)) return {};
  StatedUnit unit = known_unit(words);
  if (!unit.is_stated() && words.size() >= kShortest && words.back() == 's') {
    words.pop_back();
    unit = known_unit(words);
  }
  const size_t first = text.find_first_not_of(" \t");
  if (!unit.is_stated() && first != text.npos) unit.other = text.substr(first);
  return unit;
}

StatedUnit unit_of_code(uint32_t code) {
  if (code == 0) return {};
  for (const KnownUnit& known : kUnits) {
    if (known.code == code) return {known.unit, {}};
  }
  for (const LengthUnit& length : kLengths) {
    if (length.code == code) return {Unit::kUnknown, std::string(length.name)};
  }
  return {Unit::kUnknown, "EPSG unit " + std::to_string(code)};
}

StatedUnit unit_of_length(double metres, std::string_view name) {
  constexpr double kRounding = 1e-7;
  for (const Unit unit : kMeasures) {
    if (std::abs(metres - *metres_per(unit)) < kRounding) return {unit, {}};
  }
  const LengthUnit* nearest = nullptr;
  double least = kRounding;  // of the length
  for (const LengthUnit& length : kLengths) {
    const double difference = std::abs(metres / metres_of(length) - 1);
    if (difference >= least) continue;
    least = difference;
    nearest = &length;
  }
  return {Unit::kUnknown, std::string(nearest != nullptr ? nearest->name : name)};
}

const LengthUnit* length_named(std::string_view name) {
  for (const LengthUnit& length : kLengths) {
    if (length.name == name) return &length;
  }
  return nullptr;
}

std::optional<DecimalFactor> factor_of(const LengthUnit& length) {
  DecimalFactor factor{length.numerator, 0};
  int64_t rest = length.denominator;
  for (; rest % 10 == 0; rest /= 10) ++factor.decimals;
  if (rest != 1) return std::nullopt;
  for (; factor.numerator % 10 == 0; factor.numerator /= 10) --factor.decimals;
  return factor;
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

}  // namespace microtin::exact
