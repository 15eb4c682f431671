// SPDX-License-Identifier: MIT
// libFuzzer's mutations, for targets whose input is a stream.
#ifndef MICROTIN_FUZZ_SUPPORT_STREAM_MUTATOR_HPP
#define MICROTIN_FUZZ_SUPPORT_STREAM_MUTATOR_HPP

#include "fuzz/support/repair.hpp"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t most);

// Most mutants get right checks; some stay as they are.
extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t most, unsigned seed) {
  size = LLVMFuzzerMutate(data, size, most);
  if (seed % 16 != 0) microtin::tests::repair(data, size);
  return size;
}

#endif
