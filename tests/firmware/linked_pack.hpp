// SPDX-License-Identifier: MIT
// A pack that stream.cpp links into the image, as packs are read and served.
#ifndef MICROTIN_TESTS_FIRMWARE_LINKED_PACK_HPP
#define MICROTIN_TESTS_FIRMWARE_LINKED_PACK_HPP

#include "microtin/pack.h"
#include "tests/firmware/linked_stream.hpp"

inline int32_t read_flash(void*, uint64_t offset, uint8_t* buffer, size_t size) {
  size_t count = 0;
  for (; count < size && offset + count < stream_size(); ++count) {
    buffer[count] = stream_byte(static_cast<size_t>(offset) + count);
  }
  return static_cast<int32_t>(count);
}

// In turns of a few steps.
template <class Pack>
microtin_status serve(Pack& pack, const microtin_segment& segment) {
  microtin_status status = MICROTIN_STATUS_NEED_INPUT;
  while (status == MICROTIN_STATUS_NEED_INPUT || status == MICROTIN_STATUS_STEP_LIMIT) {
    status = pack.load_with(segment, read_flash, nullptr, 50);
  }
  return status;
}

#endif
