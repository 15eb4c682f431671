// SPDX-License-Identifier: MIT
// What a piece of work costs.
#ifndef MICROTIN_TESTS_BENCH_MEASURE_HPP
#define MICROTIN_TESTS_BENCH_MEASURE_HPP

#include <functional>
#include <string>
#include <vector>

namespace microtin::bench {

using Work = std::function<void()>;

// Seconds of processor time of one run: what else runs on the machine disturbs that less than the
// clock on the wall.
double seconds_of(const Work& work);

// Nanoseconds of processor time of each work: medians of several rounds, in each of which all take
// a turn.
std::vector<double> nanoseconds(const std::vector<Work>& works);

// Instructions of each work, run once. The program must run under
// valgrind --tool=callgrind --instr-atstart=no --callgrind-out-file=<file>.
std::vector<double> instructions(const std::vector<Work>& works, const std::string& file);

}  // namespace microtin::bench

#endif
