// SPDX-License-Identifier: MIT
#include "tests/bench/training/pack_starts.hpp"

#include <cstdio>

#include "encoder/stream/encode.hpp"
#include "tests/bench/inputs.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/training/costs.hpp"

namespace microtin::bench {
namespace {

struct Saving {
  size_t tiles = 0, bytes = 0;
  double saved = 0;  // bytes
};

// A start that differs takes a byte.
double saved_bytes(const Costs& costs) {
  double bytes = 0;
  for (uint32_t i = 0; i < kStarts; ++i) {
    const double saved = costs.cost(i, table_start(i)) - costs.cost(i, costs.best_start(i));
    if (saved > 8) bytes += saved / 8 - 1;
  }
  return bytes;
}

Saving saving_of(const Raster& raster, const LatticeOptions& options, double vertices) {
  const auto all = static_cast<double>(simplified(raster, options).tin.vertices.size());
  Saving saving;
  Costs costs;
  for (const Raster& tile : tiles_of(raster, all / vertices)) {
    const std::vector<uint8_t> stream =
        encode(simplified(tile, options).tin, {}, {0, Coding::kBalanced});
    costs.add(outcomes_of(stream));
    saving.bytes += stream.size();
    ++saving.tiles;
  }
  saving.saved = saved_bytes(costs);
  return saving;
}

}  // namespace

void print_pack_starts() {
  std::printf("| terrain | vertices a tile | tiles | bytes | saved by starts of its own |\n");
  std::printf("|---|---|---|---|---|\n");
  for (const Dataset& dataset : rasters()) {
    for (const double vertices : {1000.0, 250.0}) {
      const Saving saving = saving_of(read_raster(dataset), dataset.options, vertices);
      std::printf("| %s | %.0f | %zu | %zu | %.1f %% |\n", dataset.name, vertices, saving.tiles,
                  saving.bytes, 100 * saving.saved / static_cast<double>(saving.bytes));
    }
  }
}

}  // namespace microtin::bench
