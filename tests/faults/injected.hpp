// SPDX-License-Identifier: MIT
// Faults on demand: a request for memory, a call of the C library's file functions, or the decoder,
// fails.
#ifndef MICROTIN_TESTS_FAULTS_INJECTED_HPP
#define MICROTIN_TESTS_FAULTS_INJECTED_HPP

#include <cstdint>

namespace microtin::faults {

// Counts what is asked for, and says which of it fails.
struct Counter {
  uint64_t asked = 0;
  uint64_t first = 0;    // to fail, from 1 on; 0: none
  bool lasting = false;  // whether all later ones fail, too

  bool fails() {
    ++asked;
    return first != 0 && (asked == first || (lasting && asked > first));
  }
};

struct Counters {
  Counter memory, files;
  uint64_t largest_request = 0;  // of memory, in bytes
  Counter streams, heights;      // that the decoder refuses; that it answers wrongly
};

// Whose faults apply from now on; none if null.
void inject(Counters* counters);

}  // namespace microtin::faults

#endif
