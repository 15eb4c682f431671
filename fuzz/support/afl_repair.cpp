// SPDX-License-Identifier: MIT
// AFL++'s hook before each run: the same repair of checks that libFuzzer's mutator does.
#include <vector>

#include "fuzz/support/repair.hpp"

struct afl_state;

namespace {

std::vector<uint8_t> repaired;

}  // namespace

extern "C" void* afl_custom_init(afl_state*, unsigned) {
  return &repaired;
}

extern "C" size_t afl_custom_post_process(void*, uint8_t* bytes, size_t size, uint8_t** out) {
  repaired.assign(bytes, bytes + size);
  microtin::tests::repair(repaired.data(), size);
  *out = repaired.data();
  return size;
}

extern "C" void afl_custom_deinit(void*) {}
