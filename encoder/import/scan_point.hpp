// SPDX-License-Identifier: MIT
// What is read of a point of a laser scan, and where a record of LAS has it.
#ifndef MICROTIN_ENCODER_IMPORT_SCAN_POINT_HPP
#define MICROTIN_ENCODER_IMPORT_SCAN_POINT_HPP

#include <array>
#include <cstddef>
#include <cstdint>

#include "encoder/files/input.hpp"
#include "encoder/layers.hpp"

namespace microtin::importing {

struct ScanPoint {
  std::array<int32_t, 3> place;  // x, y and z in steps of the header's scales
  uint8_t class_code;
  bool is_withheld;
};

// The record that begins at a byte. Point formats 6 to 10 have other flags than 0 to 5 have.
inline ScanPoint scan_point_at(const ByteReader& bytes, uint64_t at, uint8_t point_format) {
  ScanPoint point{};
  for (size_t axis = 0; axis < 3; ++axis) {
    point.place[axis] = bytes.number<int32_t>(at + 4 * axis);
  }
  const auto flags = bytes.number<uint8_t>(at + 15);
  const bool is_recent = point_format >= 6;
  point.class_code = is_recent ? bytes.number<uint8_t>(at + 16) : static_cast<uint8_t>(flags & 31);
  point.is_withheld = (flags & (is_recent ? 4 : 128)) != 0;
  return point;
}

}  // namespace microtin::importing

#endif
