// SPDX-License-Identifier: MIT
// The second Cortex-M33 of QEMU's machine mps2-an521, which waits after a reset.
#include "toolchains/second_core.hpp"

#include <stdint.h>

namespace {

// Registers of the system control block of the SSE-200.
volatile uint32_t* const kFirstVectors = reinterpret_cast<volatile uint32_t*>(0x50021114);
volatile uint32_t* const kWaiting = reinterpret_cast<volatile uint32_t*>(0x50021118);

uint64_t stack[2048];
void (*run_)();

void enter() {
  run_();
  for (;;) {
  }
}

// As far as the reset: what else may happen stops the core.
struct Vectors {
  uint64_t* stack;
  void (*handlers[15])();
};
alignas(128) const Vectors vectors = {
    stack + sizeof stack / sizeof stack[0],
    {enter, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr,
     nullptr, nullptr, nullptr, nullptr, nullptr}};

}  // namespace

void start_second_core(void (*run)()) {
  run_ = run;
  __atomic_thread_fence(__ATOMIC_SEQ_CST);
  *kFirstVectors = static_cast<uint32_t>(reinterpret_cast<uintptr_t>(&vectors));
  *kWaiting = 0;
}
