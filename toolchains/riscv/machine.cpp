// SPDX-License-Identifier: MIT
// QEMU's RISC-V machine "virt": entry, serial port, the device that ends the emulation,
// semihosting and the clock.
#include <stdint.h>

#include "toolchains/board.h"
#include "toolchains/firmware.h"
#include "toolchains/semihost.hpp"
#include "toolchains/start.hpp"

namespace {

volatile uint8_t* const kSerial = reinterpret_cast<volatile uint8_t*>(0x10000000);
volatile uint32_t* const kTestDevice = reinterpret_cast<volatile uint32_t*>(0x100000);
constexpr uint32_t kTestFailed = 0x3333;  // with the exit code in the upper half
constexpr uint32_t kTestPassed = 0x5555;

// The clock of 10 MHz, and when it is to interrupt: two halves each.
volatile uint32_t* const kTime = reinterpret_cast<volatile uint32_t*>(0x200BFF8);
volatile uint32_t* const kAlarm = reinterpret_cast<volatile uint32_t*>(0x2004000);
constexpr uint32_t kTick = 2000;
constexpr uint32_t kTimerInterrupt = 0x80000007;  // as a cause

void (*on_tick_)();

// The clock stays below 2^32, some minutes; the alarm never rings between the two writes.
void set_alarm() {
  kAlarm[1] = UINT32_MAX;
  kAlarm[0] = kTime[0] + kTick;
  kAlarm[1] = 0;
}

__attribute__((interrupt("machine"), aligned(4))) void trap() {
  uint32_t cause;
  asm volatile(".option push\n.option arch, +zicsr\ncsrr %0, mcause\n.option pop" : "=r"(cause));
  if (cause != kTimerInterrupt) exit_emulator(kFault);
  set_alarm();
  on_tick_();
}

}  // namespace

// The three instructions tell the emulator that a call is meant; they are never compressed and lie
// in one page.
__attribute__((noinline, aligned(16))) uint32_t semihost(uint32_t operation, const void* argument) {
  register uint32_t a0 asm("a0") = operation;
  register const void* a1 asm("a1") = argument;
  asm volatile(R"(
    .option push
    .option norvc
    .balign 16
    slli zero, zero, 0x1f
    ebreak
    srai zero, zero, 7
    .option pop
  )"
               : "+r"(a0)
               : "r"(a1)
               : "memory");
  return a0;
}

void start_ticks(void (*on_tick)()) {
  on_tick_ = on_tick;
  set_alarm();
  asm volatile(R"(
    .option push
    .option arch, +zicsr
    csrw mtvec, %0
    csrs mie, %1
    csrsi mstatus, 8
    .option pop
  )"
               :
               : "r"(trap), "r"(1u << 7));
}

void put_char(char c) {
  *kSerial = static_cast<uint8_t>(c);
}

[[noreturn]] void exit_emulator(int code) {
  *kTestDevice = code == 0 ? kTestPassed : static_cast<uint32_t>(code) << 16 | kTestFailed;
  for (;;) {
  }
}

extern "C" __attribute__((used, aligned(4))) void fault() {
  exit_emulator(kFault);
}

asm(R"(
  .section .entry, "ax"
  .globl entry
entry:
  la sp, stack_top
  la t0, fault
  .option push
  .option arch, +zicsr
  csrw mtvec, t0
  .option pop
  j start
  .previous
)");
