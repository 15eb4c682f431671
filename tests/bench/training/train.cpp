// SPDX-License-Identifier: MIT
#include "tests/bench/training/train.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "encoder/stream/encode.hpp"
#include "encoder/terrain/fractal.hpp"
#include "shared/probability.hpp"
#include "tests/bench/inputs.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/training/outcomes.hpp"

namespace microtin::bench {
namespace {

constexpr size_t kStartsTried = 256;
constexpr size_t kOutcomes = 4096;  // of one bit in a stream; by then its start is forgotten

// What the adaptive bits cost in streams, for each of their starts, in bits.
class Costs {
 public:
  Costs() {
    for (size_t p = 1; p < kProbabilityOne; ++p) {
      cost_of_one_[p] = -std::log2(static_cast<double>(p) / kProbabilityOne);
    }
    // A quarter of a one and of a zero never seen keeps the starts of rare bits from the ends.
    for (size_t start = 0; start < kStartsTried; ++start) {
      const uint32_t p = probability(adaptive_bit(static_cast<uint32_t>(start)));
      for (auto& costs : costs_) costs[start] = 0.25 * (cost(p, true) + cost(p, false));
    }
  }

  void add(const Tin& tin) {
    for (const Coding coding : kCodings) {
      add(outcomes_of(encode(tin, {}, {0, coding})));
    }
  }

  void add(const Outcomes& outcomes) {
    for (size_t i = 0; i < kStarts; ++i) {
      seen_[i] = seen_[i] || !outcomes[i].empty();
      for (size_t start = 0; start < kStartsTried; ++start) {
        costs_[i][start] += cost_from(static_cast<uint32_t>(start), outcomes[i]);
      }
    }
  }

  void print() const {
    for (size_t i = 0; i < kStarts; ++i) {
      std::printf("%s%u,%s", i % 16 == 0 ? "    " : " ", best_start(static_cast<uint32_t>(i)),
                  i % 16 == 15 ? "\n" : "");
    }
    if (kStarts % 16 != 0) std::printf("\n");
  }

 private:
  // A bit that no stream used keeps its start.
  uint32_t best_start(uint32_t i) const {
    if (!seen_[i]) return table_start(i);
    const auto least = std::min_element(costs_[i].begin(), costs_[i].end());
    return static_cast<uint32_t>(least - costs_[i].begin());
  }

  static uint32_t probability(const AdaptiveBit& bit) {
    return static_cast<uint32_t>(probability_of(bit)) >> 1;
  }

  double cost(uint32_t probability, bool one) const {
    return cost_of_one_[one ? probability : kProbabilityOne - probability];
  }

  double cost_from(uint32_t start, const std::vector<bool>& outcomes) const {
    AdaptiveBit bit = adaptive_bit(start);
    double sum = 0;
    for (size_t i = 0; i < std::min(outcomes.size(), kOutcomes); ++i) {
      sum += cost(probability(bit), outcomes[i]);
      learn(bit, outcomes[i]);
    }
    return sum;
  }

  std::array<double, kProbabilityOne> cost_of_one_{};
  std::array<std::array<double, kStartsTried>, kStarts> costs_{};
  std::array<bool, kStarts> seen_{};
};

Raster fractal(uint64_t seed) {
  constexpr uint32_t kSize = 129;
  Raster raster;
  raster.width = raster.height = kSize;
  for (const int16_t z : fractal_heights(kSize, seed)) raster.heights.push_back(z);
  return raster;
}

LatticeOptions bounded(const char* error, const char* step) {
  LatticeOptions options;
  options.max_error = parse_decimal(error);
  options.z_step = parse_decimal(step);
  return options;
}

Costs costs_of_everything() {
  Costs costs;
  for (const Dataset& dataset : rasters()) {
    const Raster raster = read_raster(dataset);
    const auto vertices =
        static_cast<double>(simplified(raster, dataset.options).tin.vertices.size());
    for (const double size : {1000.0, 250.0}) {
      for (const Raster& tile : tiles_of(raster, vertices / size)) {
        costs.add(simplified(tile, dataset.options).tin);
      }
    }
  }
  for (const Dataset& dataset : clouds())
    costs.add(simplified(read_cloud(dataset), dataset.options).tin);
  for (uint64_t seed = 100; seed < 130; ++seed) {
    costs.add(simplified(fractal(seed), bounded("12", "10")).tin);
    costs.add(simplified(fractal(seed), bounded("4", "1")).tin);
    for (const uint32_t count : {300u, 3000u}) costs.add(uniform_tin(count, seed));
  }
  return costs;
}

}  // namespace

void print_start_probabilities() {
  const Costs costs = costs_of_everything();
  std::printf("%s%u;\n\n%s",
              R"(// SPDX-License-Identifier: MIT
// Where the adaptive bits start, in the order of Models: the probability of a one is
// (entry + 1/2) / 256. Written by `tests/bench/run train`.
#ifndef MICROTIN_SHARED_START_PROBABILITIES_HPP
#define MICROTIN_SHARED_START_PROBABILITIES_HPP

#include "shared/tables.hpp"

namespace microtin {

constexpr uint32_t kStarts = )",
              kStarts, R"(// clang-format off
constexpr uint8_t kStartTable[kStarts] MICROTIN_IN_FLASH = {
)");
  costs.print();
  std::printf(R"(};
// clang-format on

inline uint32_t table_start(uint32_t i) {
  return read_table(kStartTable + i);
}

}  // namespace microtin

#endif
)");
}

}  // namespace microtin::bench
