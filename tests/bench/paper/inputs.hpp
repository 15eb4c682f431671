// SPDX-License-Identifier: MIT
// Point sets by name and size, for the paper's claims and for how costs grow.
#ifndef MICROTIN_TESTS_BENCH_PAPER_INPUTS_HPP
#define MICROTIN_TESTS_BENCH_PAPER_INPUTS_HPP

#include <string>
#include <vector>

#include "shared/lattice.hpp"

namespace microtin::bench {

// `count` distinct places, uniform on the whole lattice, in random order.
std::vector<Point> uniform_places(uint32_t count, uint64_t seed);

struct Family {
  const char* name;
  std::vector<Point> (*points)(uint32_t count);  // distinct, about as many as asked for
};

// Uniform, clustered, a whole lattice, on few lines, on circles, on a spiral.
const std::vector<Family>& families();

}  // namespace microtin::bench

#endif
