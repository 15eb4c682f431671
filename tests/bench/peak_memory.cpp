// SPDX-License-Identifier: MIT
#include "tests/bench/peak_memory.hpp"

#include <malloc.h>

#include <fstream>

namespace microtin::bench {
namespace {

// The largest resident size since it was last reset.
double high_water_mark() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    const std::string key = "VmHWM:";
    if (line.compare(0, key.size(), key) == 0) return 1024 * std::stod(line.substr(key.size()));
  }
  return 0;
}

bool reset_high_water_mark() {
  std::ofstream file("/proc/self/clear_refs");
  file << "5";
  file.close();
  return file.good();
}

}  // namespace

std::optional<double> peak_memory(const Work& work) {
  malloc_trim(0);  // free memory must not hide what is taken from it
  if (!reset_high_water_mark()) return std::nullopt;
  const double before = high_water_mark();
  work();
  return high_water_mark() - before;
}

}  // namespace microtin::bench
