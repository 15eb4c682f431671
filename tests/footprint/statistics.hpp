// SPDX-License-Identifier: MIT
// Sum, mean and greatest of what is counted.
#ifndef MICROTIN_TESTS_FOOTPRINT_STATISTICS_HPP
#define MICROTIN_TESTS_FOOTPRINT_STATISTICS_HPP

#include <stdint.h>

class Statistics {
 public:
  void add(uint32_t value) {
    sum_ += value;
    ++count_;
    if (value > most_) most_ = value;
  }
  uint32_t sum() const { return sum_; }
  uint32_t mean() const { return sum_ / count_; }
  uint32_t most() const { return most_; }

 private:
  uint32_t sum_ = 0, count_ = 0, most_ = 0;
};

#endif
