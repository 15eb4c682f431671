// What a piece of work costs.
#ifndef MICROTIN_BENCH_MEASURE_HPP
#define MICROTIN_BENCH_MEASURE_HPP

#include <functional>
#include <string>
#include <vector>

namespace microtin::bench {

using Work = std::function<void()>;

// Wall-clock seconds of one run.
double seconds_of(const Work& work);

// Wall-clock nanoseconds of each work: medians of several rounds, in each of which all take a turn.
std::vector<double> nanoseconds(const std::vector<Work>& works);

// Instructions of each work, run once. The program must run under
// valgrind --tool=callgrind --instr-atstart=no --callgrind-out-file=<file>.
std::vector<double> instructions(const std::vector<Work>& works, const std::string& file);

}  // namespace microtin::bench

#endif
