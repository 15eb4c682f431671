// SPDX-License-Identifier: MIT
// The paper's variable length code (its Table 1): two tag bits, a sign and as many bits as the tag
// says, for x and y of the step from each point to the next.
#ifndef MICROTIN_TESTS_BENCH_PAPER_LENGTH_CODE_HPP
#define MICROTIN_TESTS_BENCH_PAPER_LENGTH_CODE_HPP

#include <cstdlib>

#include "tests/bench/paper/sequence.hpp"

namespace microtin::bench {

inline uint64_t length_code_bits(FastInt difference) {
  const FastInt size = std::abs(difference);
  const uint64_t digits = size <= 63 ? 6 : size <= 511 ? 9 : size <= 4095 ? 12 : 16;
  return 2 + 1 + digits;
}

inline uint64_t length_code_bits(const Sequence& sequence) {
  uint64_t bits = 0;
  Point previous = {0, 0};
  for (const Point p : sequence.points) {
    const Offset step = p - previous;
    bits += length_code_bits(step.x) + length_code_bits(step.y);
    previous = p;
  }
  return bits;
}

}  // namespace microtin::bench

#endif
