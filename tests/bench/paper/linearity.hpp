// SPDX-License-Identifier: MIT
// How costs grow with the number of vertices.
#ifndef MICROTIN_TESTS_BENCH_PAPER_LINEARITY_HPP
#define MICROTIN_TESTS_BENCH_PAPER_LINEARITY_HPP

#include <cstdint>
#include <functional>
#include <string>

#include "tests/bench/measure.hpp"

namespace microtin::bench {

struct CostUnit {
  std::string name;
  std::function<double(const Work&)> cost;
  uint32_t most_vertices;
};

// Measures the order of Algorithm 2, its reconstruction and the product on all families of points;
// prints costs per vertex and fitted exponents, and draws them into the file `plot`.
void print_linearity(const CostUnit& unit, const std::string& plot);

}  // namespace microtin::bench

#endif
