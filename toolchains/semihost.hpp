// SPDX-License-Identifier: MIT
// Calls of the emulator from Arm and RISC-V, by the rules of "Semihosting for AArch32 and AArch64".
#ifndef MICROTIN_TOOLCHAINS_SEMIHOST_HPP
#define MICROTIN_TOOLCHAINS_SEMIHOST_HPP

#include <stdint.h>

// An operation and its argument, a number or the place of a block of numbers.
uint32_t semihost(uint32_t operation, const void* argument);

#endif
