// SPDX-License-Identifier: MIT
// What a stream's header says beside the mesh: where it lies, in which units, and how good it is.
#ifndef MICROTIN_ENCODER_EXACT_METADATA_HPP
#define MICROTIN_ENCODER_EXACT_METADATA_HPP

#include <cstdint>
#include <optional>
#include <string>

#include "encoder/exact/decimal.hpp"
#include "encoder/layers.hpp"
#include "microtin/microtin.h"

namespace microtin::exact {

using Axis = microtin_axis;  // real = (offset + numerator * lattice) / denominator

inline double step_of(const Axis& axis) {
  return static_cast<double>(axis.numerator) / static_cast<double>(axis.denominator);
}

inline double offset_of(const Axis& axis) {
  return static_cast<double>(axis.offset) / static_cast<double>(axis.denominator);
}

enum class Unit : uint8_t { kUnknown = 0, kMetre = 1, kDegree = 2, kFoot = 3, kUsSurveyFoot = 4 };

struct Placement {
  Axis x{0, 1, 1}, y{0, 1, 1}, z{0, 1, 1};
};

// Heights in the source's unit.
struct Accuracy {
  std::optional<Decimal> bound;  // asked for
  Decimal max_error;             // measured at every sample of the source
  Decimal rms_error;
};

struct Metadata {
  Placement placement;
  Unit horizontal_unit = Unit::kUnknown;
  Unit vertical_unit = Unit::kUnknown;
  uint32_t horizontal_epsg = 0;  // 0: not stated
  uint32_t vertical_epsg = 0;
  std::string source;                  // UTF-8 text; all texts together at most 65535 bytes
  std::string date;                    // of the source: ISO 8601, 2026, 2026-11 or 2026-11-21
  std::string lineage;                 // UTF-8 text: what was done to the source
  std::optional<Decimal> water_level;  // surfaces at this very height are water
  std::optional<Accuracy> accuracy;
};

}  // namespace microtin::exact

#endif
