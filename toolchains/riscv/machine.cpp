// SPDX-License-Identifier: MIT
// QEMU's RISC-V machine "virt": entry, serial port and the device that ends the emulation.
#include <stdint.h>

#include "toolchains/firmware.h"
#include "toolchains/start.hpp"

namespace {

volatile uint8_t* const kSerial = reinterpret_cast<volatile uint8_t*>(0x10000000);
volatile uint32_t* const kTestDevice = reinterpret_cast<volatile uint32_t*>(0x100000);
constexpr uint32_t kTestFailed = 0x3333;  // with the exit code in the upper half
constexpr uint32_t kTestPassed = 0x5555;

}  // namespace

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
