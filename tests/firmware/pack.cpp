// SPDX-License-Identifier: MIT
// A pack in flash on any device: what is known along the flight of the examples.
#include "microtin/pack.hpp"

#include "decoder/examples/flight.h"
#include "tests/firmware/linked_pack.hpp"

namespace {

constexpr uint32_t kSlots = 4, kCapacity = 60;

}  // namespace

int firmware_main() {
  static microtin::Pack<kSlots, kCapacity> pack;
  const microtin_segment origin = {0, 0, 0, 0};
  microtin_pack_info info;
  uint32_t hint = 0;
  if (serve(pack, origin) != MICROTIN_STATUS_OK || pack.get_info(&info) != MICROTIN_STATUS_OK)
    return 1;
  for (int32_t i = 0; i < FLIGHT_PLACES; ++i) {
    microtin_segment here = flight_segment(i, &info);
    here.x_end = here.x;
    here.y_end = here.y;
    if (serve(pack, here) != MICROTIN_STATUS_OK) return 2;
    int32_t height = 0;
    const microtin_query_result answer = pack.height_at(here.x, here.y, &hint, &height);
    print_place(i, answer, height);
  }
  return 0;
}
