// SPDX-License-Identifier: MIT
// LAZ: the points of a LAS file, compressed in chunks.
#ifndef MICROTIN_ENCODER_IMPORT_LAZ_HPP
#define MICROTIN_ENCODER_IMPORT_LAZ_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "encoder/files/input.hpp"
#include "encoder/layers.hpp"

namespace microtin::importing {

// What is read of a point of a laser scan, and where a record of LAS has it.
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

// What a record of LAS consists of.
struct LazRecord {
  uint8_t point_format = 0;  // 0 .. 3 point by point; 6 .. 10 in layers
  uint32_t bytes = 0;
  bool has_time = false, has_colour = false;  // in formats 0 to 3
  uint32_t extra_bytes = 0;                   // in formats 0 to 3
  uint32_t layers = 0;                        // in formats 6 to 10
};

// The points of a chunk; `count` is 1 or more. Memory grows with what is decoded. Throws Error,
// which does not name the file or the chunk, if the bytes are damaged.
std::vector<ScanPoint> unpack_chunk(std::string_view bytes, uint32_t count,
                                    const LazRecord& record);

// What the header and a record of a file state about its compressed points.
struct LazHeader {
  uint8_t point_format;  // without the mark of compression
  uint16_t point_bytes;
  uint64_t first_point;  // the byte where the header says that points begin
  uint64_t points;
  std::string_view record;  // of LASzip; empty: there is none
};

// All points in their order, a list for each chunk. Chunks are decoded on all processors. Throws
// Error that names the file and the chunk.
std::vector<std::vector<ScanPoint>> unpack_laz(const std::string& name, const ByteReader& file,
                                               const LazHeader& header);

}  // namespace microtin::importing

#endif
