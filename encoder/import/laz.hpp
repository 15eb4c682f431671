// SPDX-License-Identifier: MIT
// LAZ: the points of a LAS file, compressed in chunks.
#ifndef MICROTIN_ENCODER_IMPORT_LAZ_HPP
#define MICROTIN_ENCODER_IMPORT_LAZ_HPP

#include <cstdint>
#include <string_view>
#include <vector>

#include "encoder/files/input.hpp"
#include "encoder/import/scan_point.hpp"
#include "encoder/layers.hpp"

namespace microtin::importing {

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
