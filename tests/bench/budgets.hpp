// SPDX-License-Identifier: MIT
// How well a limit of vertices, bytes or memory is used.
#ifndef MICROTIN_TESTS_BENCH_BUDGETS_HPP
#define MICROTIN_TESTS_BENCH_BUDGETS_HPP

#include <string>

namespace microtin::bench {

// Limits of vertices and of bytes, on one raster, or on three if no name is given: how near results
// come, in which time, and whether a bound that a user may try does better.
void print_budgets(const std::string& only);

}  // namespace microtin::bench

#endif
