// SPDX-License-Identifier: MIT
// What a device with small slots finds in each tile of a pack, as example firmware prints it.
#ifndef MICROTIN_TESTS_SUPPORT_REPORT_OF_TILES_HPP
#define MICROTIN_TESTS_SUPPORT_REPORT_OF_TILES_HPP

#include <doctest/doctest.h>

#include <cstdlib>
#include <string>

#include "microtin/pack.hpp"
#include "tests/firmware/tiles_report.hpp"
#include "tests/support/files.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/pack_device.hpp"
#include "tests/support/paths.hpp"

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

// Compares a pack and its report with the golden ones of this name. MICROTIN_WRITE_GOLDEN=1 writes
// both anew.
inline void check_golden_pack(const std::string& name, const Bytes& bytes) {
  CAPTURE(name);
  const std::string report = report_of_tiles(bytes);
  if (std::getenv("MICROTIN_WRITE_GOLDEN") != nullptr) {
    write_file(golden(name + ".mtp"), bytes);
    write_file(golden(name + ".report"), {report.begin(), report.end()});
  }
  CHECK(bytes == bytes_of_file(golden(name + ".mtp")));
  CHECK(report == read_file(golden(name + ".report")));
}

}  // namespace microtin::tests

#endif
