// SPDX-License-Identifier: MIT
#include "tests/bench/training/train.hpp"

#include <cstdio>

#include "encoder/stream/encode.hpp"
#include "encoder/terrain/fractal.hpp"
#include "tests/bench/inputs.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/training/costs.hpp"

namespace microtin::bench {
namespace {

Raster fractal(uint64_t seed) {
  constexpr uint32_t kSize = 129;
  Raster raster;
  raster.width = raster.height = kSize;
  for (const int16_t z : fractal_heights(kSize, seed)) raster.heights.push_back(z);
  return raster;
}

void print_starts(const Costs& costs) {
  for (uint32_t i = 0; i < kStarts; ++i) {
    std::printf("%s%u,%s", i % 16 == 0 ? "    " : " ", costs.best_start(i),
                i % 16 == 15 ? "\n" : "");
  }
  if (kStarts % 16 != 0) std::printf("\n");
}

LatticeOptions bounded(const char* error, const char* step) {
  LatticeOptions options;
  options.max_error = parse_decimal(error);
  options.z_step = parse_decimal(step);
  return options;
}

void add(Costs& costs, const Tin& tin) {
  for (const Coding coding : kCodings) costs.add(outcomes_of(encode(tin, {}, {0, coding})));
}

Costs costs_of_everything() {
  Costs costs;
  for (const Dataset& dataset : rasters()) {
    const Raster raster = read_raster(dataset);
    const auto vertices =
        static_cast<double>(simplified(raster, dataset.options).tin.vertices.size());
    for (const double size : {1000.0, 250.0}) {
      for (const Raster& tile : tiles_of(raster, vertices / size)) {
        add(costs, simplified(tile, dataset.options).tin);
      }
    }
  }
  for (const Dataset& dataset : clouds())
    add(costs, simplified(read_cloud(dataset), dataset.options).tin);
  for (uint64_t seed = 100; seed < 130; ++seed) {
    add(costs, simplified(fractal(seed), bounded("12", "10")).tin);
    add(costs, simplified(fractal(seed), bounded("4", "1")).tin);
    for (const uint32_t count : {300u, 3000u}) add(costs, uniform_tin(count, seed));
  }
  return costs;
}

}  // namespace

void print_start_probabilities() {
  const Costs costs = costs_of_everything();
  std::printf("%s%u;\n\n%s",
              R"(// SPDX-License-Identifier: MIT
// Where the adaptive bits start, in the order of Models in builds with everything: the probability of
// a one is (entry + 1/2) / 256. Written by `tests/bench/run train`.
#ifndef MICROTIN_SHARED_START_PROBABILITIES_HPP
#define MICROTIN_SHARED_START_PROBABILITIES_HPP

#include <stdint.h>

namespace microtin {

constexpr uint32_t kAllStarts = )",
              kStarts, R"(// clang-format off
constexpr uint8_t kStartTable[kAllStarts] = {
)");
  print_starts(costs);
  std::printf(R"(};
// clang-format on

}  // namespace microtin

#endif
)");
}

}  // namespace microtin::bench
