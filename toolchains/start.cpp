// SPDX-License-Identifier: MIT
// Start-up code of an image that image.ld laid out.
#include "toolchains/start.hpp"

#include <stdint.h>

#include "toolchains/firmware.h"

extern "C" {
extern uint32_t data_start[], data_end[], bss_start[], bss_end[];
extern const uint32_t data_image[];

[[noreturn]] void start() {
  const uint32_t* from = data_image;
  for (uint32_t* to = data_start; to != data_end; ++to) *to = *from++;
  for (uint32_t* to = bss_start; to != bss_end; ++to) *to = 0;
  exit_emulator(firmware_main());
}
}
