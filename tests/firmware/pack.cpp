// SPDX-License-Identifier: MIT
// A pack in flash on any device: what is known along the flight of the examples.
#include "microtin/pack.hpp"

#include "decoder/examples/flight.h"
#include "tests/firmware/linked_stream.hpp"

namespace {

constexpr uint32_t kSlots = 4, kCapacity = 60;

int32_t read_flash(void*, uint64_t offset, uint8_t* buffer, size_t size) {
  size_t count = 0;
  for (; count < size && offset + count < stream_size(); ++count) {
    buffer[count] = stream_byte(static_cast<size_t>(offset) + count);
  }
  return static_cast<int32_t>(count);
}

// In turns of a few steps.
microtin_status serve(microtin::Pack<kSlots, kCapacity>& pack, const microtin_course& course) {
  microtin_status status = MICROTIN_NEED_INPUT;
  while (status == MICROTIN_NEED_INPUT || status == MICROTIN_STEP_LIMIT) {
    status = pack.service(course, 50, read_flash, nullptr);
  }
  return status;
}

}  // namespace

int firmware_main() {
  static microtin::Pack<kSlots, kCapacity> pack;
  const microtin_course origin = {0, 0, 0, 0};
  microtin_pack_info info;
  uint32_t hint = 0;
  if (serve(pack, origin) != MICROTIN_DONE || !pack.header(&info)) return 1;
  for (int32_t i = 0; i < FLIGHT_PLACES; ++i) {
    microtin_course here = flight_course(i, &info);
    here.x_end = here.x;
    here.y_end = here.y;
    if (serve(pack, here) != MICROTIN_DONE) return 2;
    int32_t height = 0;
    const microtin_answer answer = pack.height_at(here.x, here.y, &hint, &height);
    print_place(i, answer, height);
  }
  return 0;
}
