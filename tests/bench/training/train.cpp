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

// Where in Models the parts begin and end that a build may leave out, but for their first entry.
struct Optional {
  size_t begin, end;
  const char* left_out_by;
};

constexpr Optional kOptional[] = {
    {offsetof(Models, place.calibration), offsetof(Models, place.quick), "MICROTIN_ONLY_QUICK"},
    {offsetof(Models, place.quick), offsetof(Models, height), "MICROTIN_ONLY_BALANCED"},
    {offsetof(Models, is_void), sizeof(Models), "MICROTIN_NO_VOIDS"},
};

// How many bits of such a part every build has.
size_t kept(const Optional& part) {
  if (part.begin == offsetof(Models, is_void)) return 1;
  return part.begin == offsetof(Models, place.quick) ? sizeof(Quarters) / sizeof(AdaptiveBit)
                                                     : sizeof(Calibration) / sizeof(AdaptiveBit);
}

void print_row(const Costs& costs, size_t begin, size_t end) {
  for (size_t i = begin; i < end; ++i) {
    const bool first = (i - begin) % 16 == 0, last = (i - begin) % 16 == 15 || i + 1 == end;
    std::printf("%s%u,%s", first ? "    " : " ", costs.best_start(static_cast<uint32_t>(i)),
                last ? "\n" : "");
  }
}

void print_starts(const Costs& costs) {
  size_t at = 0;
  for (const Optional& part : kOptional) {
    const size_t begin = part.begin / sizeof(AdaptiveBit), end = part.end / sizeof(AdaptiveBit);
    print_row(costs, at, begin);
    print_row(costs, begin, begin + kept(part));
    std::printf("#if !defined(%s)\n", part.left_out_by);
    print_row(costs, begin + kept(part), end);
    std::printf("#endif\n");
    at = end;
  }
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
  std::printf("%s", R"(// SPDX-License-Identifier: MIT
// Where the adaptive bits start, in the order of Models: the probability of a one is
// (entry + 1/2) / 256. Parts that this build leaves out keep one entry. Written by
// `tests/bench/run train`.
#ifndef MICROTIN_SHARED_START_PROBABILITIES_HPP
#define MICROTIN_SHARED_START_PROBABILITIES_HPP

#include "microtin/config.h"
#include "shared/tables.hpp"

namespace microtin {

// clang-format off
constexpr uint8_t kStartTable[] MICROTIN_IN_FLASH = {
)");
  print_starts(costs);
  std::printf("%s", R"(};
// clang-format on

}  // namespace microtin

#endif
)");
}

}  // namespace microtin::bench
