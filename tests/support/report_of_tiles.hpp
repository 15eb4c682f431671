// SPDX-License-Identifier: MIT
// What a device with small slots finds in each tile of a pack, as example firmware prints it.
#ifndef MICROTIN_TESTS_SUPPORT_REPORT_OF_TILES_HPP
#define MICROTIN_TESTS_SUPPORT_REPORT_OF_TILES_HPP

#include <string>

#include "microtin/pack.hpp"
#include "tests/firmware/tiles_report.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/pack_device.hpp"

namespace microtin::tests {

inline std::string report_of_tiles(const Bytes& bytes) {
  Card card{bytes};
  std::string report;
  Pack<4, 8> pack;
  report_tiles(
      pack,
      [&](Pack<4, 8>& from, const microtin_segment& segment) {
        return from.load_with(segment, Card::read, &card);
      },
      [&](const char* text) { report += text; },
      [&](int32_t number) { report += std::to_string(number); });
  return report;
}

}  // namespace microtin::tests

#endif
