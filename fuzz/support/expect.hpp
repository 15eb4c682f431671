// SPDX-License-Identifier: MIT
// What a target holds to be true.
#ifndef MICROTIN_FUZZ_SUPPORT_EXPECT_HPP
#define MICROTIN_FUZZ_SUPPORT_EXPECT_HPP

#include <cstdio>
#include <cstdlib>

// A finding: says where, and ends the program.
#define EXPECT(truth)                                                          \
  do {                                                                         \
    if (!(truth)) {                                                            \
      std::fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #truth); \
      std::abort();                                                            \
    }                                                                          \
  } while (false)

#endif
