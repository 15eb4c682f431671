// SPDX-License-Identifier: MIT
// Arm Cortex-M under emulation: vectors, semihosting and the clock.
#include <stdint.h>

#include "toolchains/board.h"
#include "toolchains/firmware.h"
#include "toolchains/semihost.hpp"
#include "toolchains/start.hpp"

extern "C" uint32_t stack_top[];

namespace {

// Arm semihosting: an operation and one argument, served by the emulator.
constexpr uint32_t kWriteCharacter = 0x03;
constexpr uint32_t kExitExtended = 0x20;
constexpr uint32_t kApplicationExit = 0x20026;

void fault() {
  exit_emulator(kFault);
}

using Handler = void (*)();

Handler on_tick_;

void tick() {
  on_tick_();
}

// The vector table of the processor: stack, reset, NMI, the faults, calls of a system, and last the
// tick of its clock.
struct Vectors {
  uint32_t* stack;
  Handler handlers[15];
};

}  // namespace

uint32_t semihost(uint32_t operation, const void* argument) {
  register uint32_t r0 asm("r0") = operation;
  register const void* r1 asm("r1") = argument;
  asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}

void start_ticks(Handler on_tick) {
  volatile uint32_t* const clock = reinterpret_cast<volatile uint32_t*>(0xE000E010);  // SysTick
  enum Register { kControl, kReload };
  on_tick_ = on_tick;
  clock[kReload] = 5000;  // of 20 to 25 MHz
  clock[kControl] = 7;    // the processor's clock, interrupts, on
}

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
const Vectors entry = {stack_top,
                       {start, fault, fault, fault, fault, fault, fault, fault, fault, fault, fault,
                        fault, fault, fault, tick}};
