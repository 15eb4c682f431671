// SPDX-License-Identifier: MIT
// The figures of the paper's systems that are the same on every machine, against recorded ones.
#ifndef MICROTIN_TESTS_BENCH_PAPER_FIGURES_HPP
#define MICROTIN_TESTS_BENCH_PAPER_FIGURES_HPP

#include <string>

namespace microtin::bench {

// Prints what differs from the file, and throws Error if something does.
void check_figures(const std::string& path);

void record_figures(const std::string& path);

}  // namespace microtin::bench

#endif
