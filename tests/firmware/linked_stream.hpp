// SPDX-License-Identifier: MIT
// The stream that stream.cpp links into the image.
#ifndef MICROTIN_TESTS_FIRMWARE_LINKED_STREAM_HPP
#define MICROTIN_TESTS_FIRMWARE_LINKED_STREAM_HPP

#include <stddef.h>
#include <stdint.h>

#include "shared/tables.hpp"

// In flash: on AVR, read it by stream_byte only.
extern "C" const uint8_t stream_begin[];
extern "C" const uint8_t stream_end[];

inline size_t stream_size() {
  return static_cast<size_t>(stream_end - stream_begin);
}

inline uint8_t stream_byte(size_t i) {
  return microtin::read_table(stream_begin + i);
}

#endif
