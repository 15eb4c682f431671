// SPDX-License-Identifier: MIT
// How much memory a piece of work takes.
#ifndef MICROTIN_TESTS_BENCH_PEAK_MEMORY_HPP
#define MICROTIN_TESTS_BENCH_PEAK_MEMORY_HPP

#include <optional>

#include "tests/bench/measure.hpp"

namespace microtin::bench {

// By how many bytes the resident memory grows at most during the work; nothing where the system
// does not tell.
std::optional<double> peak_memory(const Work& work);

}  // namespace microtin::bench

#endif
