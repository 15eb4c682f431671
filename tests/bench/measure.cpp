// SPDX-License-Identifier: MIT
#include "tests/bench/measure.hpp"

#include <algorithm>
#include <array>
#include <ctime>
#include <fstream>

#include "encoder/base/error.hpp"
#include "tests/bench/layers.hpp"

#ifdef MICROTIN_BENCH_VALGRIND
#include <valgrind/callgrind.h>
#endif

namespace microtin::bench {
namespace {

constexpr size_t kRounds = 5;

}  // namespace

double seconds_of(const Work& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

std::vector<double> nanoseconds(const std::vector<Work>& works) {
  std::vector<std::array<double, kRounds>> seconds(works.size());
  for (size_t round = 0; round < kRounds; ++round) {
    for (size_t i = 0; i < works.size(); ++i) seconds[i][round] = seconds_of(works[i]);
  }
  std::vector<double> medians;
  for (auto& rounds : seconds) {
    std::nth_element(rounds.begin(), rounds.begin() + kRounds / 2, rounds.end());
    medians.push_back(1e9 * rounds[kRounds / 2]);
  }
  return medians;
}

#ifdef MICROTIN_BENCH_VALGRIND
namespace {

// The total of a file that callgrind wrote.
double total_in(const std::string& path) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::string key = "totals: ";
    if (line.compare(0, key.size(), key) == 0) return std::stod(line.substr(key.size()));
  }
  throw Error(path + ": callgrind wrote no totals");
}

}  // namespace

std::vector<double> instructions(const std::vector<Work>& works, const std::string& file) {
  static int dumps = 0;  // callgrind numbers its files
  std::vector<double> counts;
  for (const Work& work : works) {
    CALLGRIND_START_INSTRUMENTATION;
    CALLGRIND_ZERO_STATS;
    work();
    CALLGRIND_STOP_INSTRUMENTATION;
    CALLGRIND_DUMP_STATS;
    counts.push_back(total_in(file + "." + std::to_string(++dumps)));
  }
  return counts;
}
#else
std::vector<double> instructions(const std::vector<Work>&, const std::string&) {
  throw Error("built without valgrind's headers");
}
#endif

}  // namespace microtin::bench
