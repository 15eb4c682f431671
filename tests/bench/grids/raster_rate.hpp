// SPDX-License-Identifier: MIT
// Codecs for rasters at an equal largest error.
#ifndef MICROTIN_TESTS_BENCH_GRIDS_RASTER_RATE_HPP
#define MICROTIN_TESTS_BENCH_GRIDS_RASTER_RATE_HPP

#include <cstdint>
#include <vector>

#include "tests/bench/surface.hpp"

namespace microtin::bench {

// A raster as LERC takes it.
struct ShortRaster {
  uint32_t width, height;
  std::vector<int16_t> heights;
  Bytes valid;  // by post: 1 or 0
};

Bytes encode_with_lerc(const ShortRaster& raster, double max_error);
ShortRaster decode_with_lerc(const Bytes& bytes, uint32_t width, uint32_t height);

void print_raster_rate();

}  // namespace microtin::bench

#endif
