// SPDX-License-Identifier: MIT
// Counting by the processor's own counter, which is exact under QEMU with -icount shift=0.
#include "toolchains/counter.hpp"

namespace {

uint32_t read_counter() {
  uint32_t count;
  asm volatile(R"(
    .option push
    .option arch, +zicsr
    csrr %0, minstret
    .option pop
  )"
               : "=r"(count));
  return count;
}

}  // namespace

uint32_t instruction_count() {
  static const uint32_t first = read_counter();
  return read_counter() - first;
}
