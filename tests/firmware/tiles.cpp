// SPDX-License-Identifier: MIT
// A pack in flash, tile by tile: what is loaded, and why a tile is bad.
#include "decoder/examples/print.h"
#include "tests/firmware/linked_pack.hpp"
#include "tests/firmware/tiles_report.hpp"

int firmware_main() {
  static microtin::Pack<4, 8> pack;
  microtin::report_tiles(
      pack,
      [](microtin::Pack<4, 8>& from, const microtin_segment& segment) {
        return serve(from, segment);
      },
      [](const char* text) { print(text); }, [](int32_t number) { print_number(number); });
  return 0;
}
