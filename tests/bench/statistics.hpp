// SPDX-License-Identifier: MIT
// Means over several inputs and how far they spread.
#ifndef MICROTIN_TESTS_BENCH_STATISTICS_HPP
#define MICROTIN_TESTS_BENCH_STATISTICS_HPP

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/bench/table.hpp"

namespace microtin::bench {

class Sample {
 public:
  void add(double value) { values_.push_back(value); }

  double mean() const {
    double sum = 0;
    for (const double value : values_) sum += value;
    return sum / static_cast<double>(values_.size());
  }

  // The standard deviation.
  double spread() const {
    if (values_.size() < 2) return 0;
    double sum = 0;
    for (const double value : values_) sum += (value - mean()) * (value - mean());
    return std::sqrt(sum / static_cast<double>(values_.size() - 1));
  }

  double median() const {
    std::vector<double> sorted = values_;
    std::sort(sorted.begin(), sorted.end());
    return sorted[sorted.size() / 2];
  }

  double least() const { return *std::min_element(values_.begin(), values_.end()); }

 private:
  std::vector<double> values_;
};

inline std::string with_spread(const Sample& sample, int decimals) {
  return number(sample.mean(), decimals) + " ± " + number(sample.spread(), decimals);
}

}  // namespace microtin::bench

#endif
