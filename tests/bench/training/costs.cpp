// SPDX-License-Identifier: MIT
#include "tests/bench/training/costs.hpp"

#include <algorithm>
#include <cmath>

namespace microtin::bench {
namespace {

constexpr size_t kOutcomes = 4096;  // of one bit in a stream; by then its start is forgotten

uint32_t probability(const AdaptiveBit& bit) {
  return static_cast<uint32_t>(probability_of(bit)) >> 1;
}

}  // namespace

Costs::Costs() {
  for (size_t p = 1; p < kProbabilityOne; ++p) {
    cost_of_one_[p] = -std::log2(static_cast<double>(p) / kProbabilityOne);
  }
  // A quarter of a one and of a zero never seen keeps the starts of rare bits from the ends.
  for (size_t start = 0; start < kStartsTried; ++start) {
    const uint32_t p = probability(adaptive_bit(static_cast<uint32_t>(start)));
    for (auto& costs : costs_) costs[start] = 0.25 * (cost_of(p, true) + cost_of(p, false));
  }
}

void Costs::add(const Outcomes& outcomes) {
  for (size_t i = 0; i < kStarts; ++i) {
    seen_[i] = seen_[i] || !outcomes[i].empty();
    for (size_t start = 0; start < kStartsTried; ++start) {
      costs_[i][start] += cost_from(static_cast<uint32_t>(start), outcomes[i]);
    }
  }
}

uint32_t Costs::best_start(uint32_t i) const {
  if (!seen_[i]) return table_start(i);
  const auto least = std::min_element(costs_[i].begin(), costs_[i].end());
  return static_cast<uint32_t>(least - costs_[i].begin());
}

double Costs::cost_of(uint32_t probability, bool one) const {
  return cost_of_one_[one ? probability : kProbabilityOne - probability];
}

double Costs::cost_from(uint32_t start, const std::vector<bool>& outcomes) const {
  AdaptiveBit bit = adaptive_bit(start);
  double sum = 0;
  for (size_t i = 0; i < std::min(outcomes.size(), kOutcomes); ++i) {
    sum += cost_of(probability(bit), outcomes[i]);
    learn(bit, outcomes[i]);
  }
  return sum;
}

}  // namespace microtin::bench
