// SPDX-License-Identifier: MIT
// Counting instructions, on machines that can.
#ifndef MICROTIN_TOOLCHAINS_COUNTER_HPP
#define MICROTIN_TOOLCHAINS_COUNTER_HPP

#include <stdint.h>

// Instructions executed since the first call, which returns 0. The emulator must run with
// MICROTIN_COUNTING_OPTIONS.
uint32_t instruction_count();

#endif
