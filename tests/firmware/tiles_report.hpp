// SPDX-License-Identifier: MIT
// Describes each tile of a pack in a line of text, the same on host and device: how loading it
// ended, why it is bad, and the height in its middle.
#ifndef MICROTIN_TESTS_FIRMWARE_TILES_REPORT_HPP
#define MICROTIN_TESTS_FIRMWARE_TILES_REPORT_HPP

#include "microtin/pack.hpp"

namespace microtin {

template <class Device>
uint32_t reason_of(const Device& pack, uint32_t tile) {
  uint32_t number = 0, why = 0;
  for (uint32_t i = 0; i < MICROTIN_PACK_MAX_BAD_TILES; ++i) {
    if (pack.bad_tile(i, &number, &why) == MICROTIN_STATUS_OK && number == tile) return why;
  }
  return MICROTIN_STATUS_OK;
}

// `serve` loads a segment, and returns the last status; `text` and `number` print.
template <class Device, class Serve, class Text, class Number>
void report_tiles(Device& pack, Serve serve, Text text, Number number) {
  const microtin_segment nowhere = {-256, -256, -256, -256};
  const microtin_status status = serve(pack, nowhere);
  text("header ");
  number(static_cast<int32_t>(status));
  text("\n");
  microtin_pack_info info;
  if (pack.get_info(&info) != MICROTIN_STATUS_OK) return;
  uint32_t tile = 0;
  for (uint32_t y = 0; y < info.y_max; y += info.tile_height) {
    for (uint32_t x = 0; x < info.x_max; x += info.tile_width, ++tile) {
      const int64_t px = static_cast<int64_t>(x) * 256 + 300;
      const int64_t py = static_cast<int64_t>(y) * 256 + 300;
      const microtin_segment place = {px, py, px, py};
      text("tile ");
      number(static_cast<int32_t>(serve(pack, place)));
      text(" ");
      number(static_cast<int32_t>(reason_of(pack, tile)));
      uint32_t hint = 0;
      int32_t height = 0;
      text(" height ");
      number(static_cast<int32_t>(pack.height_at(px, py, &hint, &height)));
      text(" ");
      number(height);
      text("\n");
    }
  }
}

}  // namespace microtin

#endif
