// SPDX-License-Identifier: MIT
// Counting by a CMSDK timer of the MPS2 boards: it counts down once every 40 ns, and QEMU with
// -icount shift=6 takes 64 ns for each instruction.
#include "toolchains/counter.hpp"

namespace {

volatile uint32_t* const kControl = reinterpret_cast<volatile uint32_t*>(0x40000000);
volatile uint32_t* const kValue = reinterpret_cast<volatile uint32_t*>(0x40000004);

}  // namespace

uint32_t instruction_count() {
  if (*kControl == 0) {
    *kValue = UINT32_MAX;
    *kControl = 1;
  }
  return static_cast<uint32_t>(uint64_t{UINT32_MAX - *kValue} * 40 / 64);
}
