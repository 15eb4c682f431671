// SPDX-License-Identifier: MIT
// LERC: rasters within a largest error.
#include <Lerc_c_api.h>

#include "encoder/base/error.hpp"
#include "tests/bench/grids/raster_rate.hpp"
#include "tests/bench/layers.hpp"

namespace microtin::bench {
namespace {

constexpr unsigned kShort = 2;  // its name for int16_t

void expect_ok(lerc_status status) {
  if (status != 0) throw Error("LERC: error " + std::to_string(status));
}

}  // namespace

Bytes encode_with_lerc(const ShortRaster& raster, double max_error) {
  const int width = static_cast<int>(raster.width), height = static_cast<int>(raster.height);
  unsigned size = 0;
  expect_ok(lerc_computeCompressedSize(raster.heights.data(), kShort, 1, width, height, 1, 1,
                                       raster.valid.data(), max_error, &size));
  Bytes bytes(size);
  unsigned written = 0;
  expect_ok(lerc_encode(raster.heights.data(), kShort, 1, width, height, 1, 1, raster.valid.data(),
                        max_error, bytes.data(), size, &written));
  bytes.resize(written);
  return bytes;
}

ShortRaster decode_with_lerc(const Bytes& bytes, uint32_t width, uint32_t height) {
  const size_t posts = size_t{width} * height;
  ShortRaster raster{width, height, std::vector<int16_t>(posts), Bytes(posts)};
  expect_ok(lerc_decode(bytes.data(), static_cast<unsigned>(bytes.size()), 1, raster.valid.data(),
                        1, static_cast<int>(width), static_cast<int>(height), 1, kShort,
                        raster.heights.data()));
  return raster;
}

}  // namespace microtin::bench
