// SPDX-License-Identifier: MIT
// What adaptive bits cost, for each probability that they may start with.
#ifndef MICROTIN_TESTS_BENCH_TRAINING_COSTS_HPP
#define MICROTIN_TESTS_BENCH_TRAINING_COSTS_HPP

#include <array>
#include <cstdint>
#include <vector>

#include "shared/probability.hpp"
#include "tests/bench/training/outcomes.hpp"

namespace microtin::bench {

constexpr size_t kStartsTried = 256;

class Costs {
 public:
  Costs();

  void add(const Outcomes& outcomes);

  // The start that costs least. A bit that no stream used keeps its own.
  uint32_t best_start(uint32_t i) const;

  // In bits.
  double cost(uint32_t i, uint32_t start) const { return costs_[i][start]; }

 private:
  double cost_of(uint32_t probability, bool one) const;
  double cost_from(uint32_t start, const std::vector<bool>& outcomes) const;

  std::array<double, kProbabilityOne> cost_of_one_{};
  std::array<std::array<double, kStartsTried>, kStarts> costs_{};
  std::array<bool, kStarts> seen_{};
};

}  // namespace microtin::bench

#endif
