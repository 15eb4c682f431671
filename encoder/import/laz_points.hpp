// SPDX-License-Identifier: MIT
// The points of a chunk of LAZ, out of its bytes.
#ifndef MICROTIN_ENCODER_IMPORT_LAZ_POINTS_HPP
#define MICROTIN_ENCODER_IMPORT_LAZ_POINTS_HPP

#include <cstdint>
#include <string_view>
#include <vector>

#include "encoder/import/scan_point.hpp"
#include "encoder/layers.hpp"

namespace microtin::importing {

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

}  // namespace microtin::importing

#endif
