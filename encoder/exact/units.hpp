// SPDX-License-Identifier: MIT
// Units of coordinates by name and by length.
#ifndef MICROTIN_ENCODER_EXACT_UNITS_HPP
#define MICROTIN_ENCODER_EXACT_UNITS_HPP

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "encoder/layers.hpp"

namespace microtin::exact {

enum class Unit : uint8_t { kUnknown = 0, kMetre = 1, kDegree = 2, kFoot = 3, kUsSurveyFoot = 4 };

// "metre", "US survey foot", "unknown".
std::string_view name_of(Unit unit);

// "m", "ft"; empty if it is not known or of no fixed length.
std::string_view symbol_of(Unit unit);

// A unit of length that streams do not have, as a multiple of one that they have.
struct LengthUnit {
  uint32_t code;          // of EPSG's units of measure; 0: it has none
  std::string_view name;  // as EPSG names it
  Unit base;
  int64_t numerator, denominator;  // of base, exactly, as EPSG defines it
};

// All that are known, as begin and end.
const LengthUnit* begin_of_lengths();
const LengthUnit* end_of_lengths();

// A unit as a file states it.
struct StatedUnit {
  Unit unit = Unit::kUnknown;
  std::string other;  // name of one that streams do not have; the unit is kUnknown then

  bool is_stated() const { return unit != Unit::kUnknown || !other.empty(); }
};

// As files and people write it, in any case: m, metre, meters, deg, ft, feet, us-ft, US survey
// foot, cm, km, fathom, Clarke's foot, ... `other` is EPSG's name or, if nobody knows it, the text.
// An empty text states nothing.
StatedUnit unit_named(std::string_view text);

// By its code of EPSG's units of measure. 0 states nothing.
StatedUnit unit_of_code(uint32_t code);

// By its length, within 10^-7 of it, as files round it; its name there is reported if it is not
// known.
StatedUnit unit_of_length(double metres, std::string_view name);

// Null: there is none.
const LengthUnit* length_named(std::string_view name);

// What a number in that unit is multiplied by: numerator / 10^decimals of its base.
struct DecimalFactor {
  int64_t numerator = 1;
  int decimals = 0;
};

// Nothing if no decimal is exact, as for a third.
std::optional<DecimalFactor> factor_of(const LengthUnit& length);

// Nothing if it is not known or of no fixed length.
std::optional<double> metres_per(Unit unit);

}  // namespace microtin::exact

#endif
