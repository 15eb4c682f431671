// SPDX-License-Identifier: MIT
// What the images print: a line for each number and each height, read by
// tests/bench/grids/flight.cpp.
#ifndef MICROTIN_TESTS_BENCH_DEVICE_FLIGHT_LOG_HPP
#define MICROTIN_TESTS_BENCH_DEVICE_FLIGHT_LOG_HPP

#include "tests/firmware/report.hpp"
#include "toolchains/firmware.h"

namespace microtin {

inline void log(const char* what, uint32_t number) {
  print(put_char, what);
  print(put_char, " ");
  print(put_char, number);
  print(put_char, "\n");
}

// Decimetres at the flight's next post.
inline void log_height(int32_t height) {
  print(put_char, "height ");
  print(put_char, height);
  print(put_char, "\n");
}

// The sum and the largest of several costs.
struct Costs {
  uint32_t count = 0, most = 0;
  uint64_t all = 0;

  void add(uint32_t cost) {
    ++count;
    all += cost;
    if (cost > most) most = cost;
  }
  uint32_t mean() const { return count == 0 ? 0 : static_cast<uint32_t>(all / count); }
};

}  // namespace microtin

#endif
