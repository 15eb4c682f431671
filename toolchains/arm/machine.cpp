// SPDX-License-Identifier: MIT
// Arm Cortex-M under emulation: vectors and semihosting.
#include <stdint.h>

#include "toolchains/firmware.h"
#include "toolchains/start.hpp"

extern "C" uint32_t stack_top[];

namespace {

// Arm semihosting: an operation and one argument, served by the emulator.
constexpr uint32_t kWriteCharacter = 0x03;
constexpr uint32_t kExitExtended = 0x20;
constexpr uint32_t kApplicationExit = 0x20026;

void semihost(uint32_t operation, const void* argument) {
  register uint32_t r0 asm("r0") = operation;
  register const void* r1 asm("r1") = argument;
  asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

void fault() {
  exit_emulator(kFault);
}

using Handler = void (*)();

// The first entries of the vector table: stack, reset, then NMI and the faults.
struct Vectors {
  uint32_t* stack;
  Handler handlers[6];
};

}  // namespace

void put_char(char c) {
  semihost(kWriteCharacter, &c);
}

[[noreturn]] void exit_emulator(int code) {
  const uint32_t block[2] = {kApplicationExit, static_cast<uint32_t>(code)};
  semihost(kExitExtended, block);
  for (;;) {
  }
}

extern "C" __attribute__((section(".entry"), used))
const Vectors entry = {stack_top, {start, fault, fault, fault, fault, fault}};
