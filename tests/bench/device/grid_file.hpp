// SPDX-License-Identifier: MIT
// A grid file in the manner of ArduPilot's: blocks of 2,048 bytes that overlap. Host and device,
// both little-endian.
#ifndef MICROTIN_TESTS_BENCH_DEVICE_GRID_FILE_HPP
#define MICROTIN_TESTS_BENCH_DEVICE_GRID_FILE_HPP

#include <stdint.h>

namespace microtin {

// What the file begins with; blocks follow, row by row from the south-west.
struct GridFile {
  static constexpr uint32_t kBlockRows = 28, kBlockColumns = 32;
  static constexpr uint32_t kOwnRows = 24, kOwnColumns = 28;  // the others repeat neighbours
  static constexpr uint32_t kBlockBytes = 2048;               // 1,792 of heights in metres
  static constexpr uint32_t kHeaderBytes = 32;

  uint32_t block_columns, block_rows;
  uint32_t spacing_millimetres;
  uint32_t x_max, y_max;                         // last post of the source
  uint32_t column_millimetres, row_millimetres;  // between its posts
};
static_assert(sizeof(GridFile) <= GridFile::kHeaderBytes, "it has its place");

}  // namespace microtin

#endif
