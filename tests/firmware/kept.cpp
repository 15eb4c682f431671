// SPDX-License-Identifier: MIT
// A pack in flash whose tiles are all kept, compact, in the 16 KB of RAM of a small device, next to
// 4 KB for the application: heights along the flight of the examples, without a read.
#include "decoder/examples/flight.h"
#include "microtin/compact_pack.hpp"
#include "tests/firmware/linked_pack.hpp"

#ifdef __AVR__
#define BEHIND_DATA __heap_start
#else
#define BEHIND_DATA bss_end
#endif
extern "C" uint8_t BEHIND_DATA[];  // up to the stack

namespace {

constexpr uint32_t kSlots = 9, kCapacity = 64, kTileBytes = 616;  // as microtin info says
constexpr uint32_t kApplicationBytes = 4096, kFree = 16;
constexpr uint8_t kPaint = 0xA5;

volatile uint8_t application[kApplicationBytes];
microtin::CompactPack<kSlots, kCapacity, kTileBytes> pack(microtin::defer_init);

uint8_t own_byte(uint32_t i) {
  return static_cast<uint8_t>(i * 7 + i / 256);
}

// Paints the last bytes that the stack may take.
void begin() {
  for (uint32_t i = 0; i < kApplicationBytes; ++i) application[i] = own_byte(i);
  for (uint32_t i = 0; i < kFree; ++i) BEHIND_DATA[i] = kPaint;
}

bool is_untouched() {
  bool is_well = true;
  for (uint32_t i = 0; i < kApplicationBytes; ++i) {
    is_well = is_well && application[i] == own_byte(i);
  }
  for (uint32_t i = 0; i < kFree; ++i) is_well = is_well && BEHIND_DATA[i] == kPaint;
  return is_well;
}

// Has all tiles there, one after the other.
microtin_status fetch_all(microtin_pack_info& info) {
  microtin_status status = serve(pack, {0, 0, 0, 0});
  if (status != MICROTIN_STATUS_OK || pack.get_info(&info) != MICROTIN_STATUS_OK) return status;
  for (uint32_t y = 0; y < info.y_max; y += info.tile_height) {
    for (uint32_t x = 0; x < info.x_max; x += info.tile_width) {
      const int64_t px = static_cast<int64_t>(x) * 256 + 128;
      const int64_t py = static_cast<int64_t>(y) * 256 + 128;
      status = serve(pack, {px, py, px, py});
      if (status != MICROTIN_STATUS_OK) return status;
    }
  }
  return status;
}

}  // namespace

int firmware_main() {
  begin();
  microtin_pack_info info;
  if (pack.begin() != MICROTIN_STATUS_OK || fetch_all(info) != MICROTIN_STATUS_OK) return 1;
  uint32_t hint = 0;
  for (int32_t i = 0; i < FLIGHT_PLACES; ++i) {
    const microtin_segment here = flight_segment(i, &info);
    int32_t height = 0;
    const microtin_query_result answer = pack.height_at(here.x, here.y, &hint, &height);
    print_place(i, answer, height);
  }
  if (is_untouched()) return 0;
  print("the stack took what is not its own\n");
  return 2;
}
