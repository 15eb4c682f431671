// SPDX-License-Identifier: MIT
// Counts instructions under emulation.
#ifndef MICROTIN_TESTS_BENCH_DEVICE_INSTRUCTION_COUNTER_HPP
#define MICROTIN_TESTS_BENCH_DEVICE_INSTRUCTION_COUNTER_HPP

#include <stdint.h>

namespace microtin {

// A CMSDK timer: counts down, once every 40 ns. QEMU with -icount shift=6 takes 64 ns for each
// instruction.
class InstructionCounter {
 public:
  InstructionCounter() {
    timer()[kValue] = UINT32_MAX;
    timer()[kControl] = 1;
  }

  uint32_t count() const {
    return static_cast<uint32_t>(uint64_t{UINT32_MAX - timer()[kValue]} * 40 / 64);
  }

 private:
  enum Register { kControl, kValue };

  static volatile uint32_t* timer() { return reinterpret_cast<volatile uint32_t*>(0x40000000); }
};

}  // namespace microtin

#endif
