// SPDX-License-Identifier: MIT
// The flight on which readers of terrain are measured: over posts of a raster, so that the source
// tells every height. Host and device.
#ifndef MICROTIN_TESTS_BENCH_DEVICE_FLIGHT_HPP
#define MICROTIN_TESTS_BENCH_DEVICE_FLIGHT_HPP

#include <stdint.h>

namespace microtin {

struct Post {
  int32_t x, y;
};

// From an eighth of the width and 5/8 of the height on, a post east and half a post north at a
// time, over half the width.
class Flight {
 public:
  static constexpr int32_t kAhead = 32;  // posts that the vehicle looks ahead

  Flight(uint32_t x_max, uint32_t y_max)
      : start_{static_cast<int32_t>(x_max / 8), static_cast<int32_t>(y_max / 8 * 5)},
        posts_(static_cast<int32_t>(x_max / 2)) {}

  int32_t posts() const { return posts_; }
  Post post(int32_t i) const { return {start_.x + i, start_.y + i / 2}; }
  Post ahead(int32_t i) const { return post(i + kAhead < posts_ ? i + kAhead : posts_ - 1); }

 private:
  Post start_;
  int32_t posts_;
};

}  // namespace microtin

#endif
