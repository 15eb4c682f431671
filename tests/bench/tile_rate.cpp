// SPDX-License-Identifier: MIT
// How many bytes more a terrain takes in tiles.
#include <algorithm>
#include <optional>

#include "encoder/base/error.hpp"
#include "encoder/stream/encode.hpp"
#include "tests/bench/inputs.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/rate.hpp"
#include "tests/bench/surface.hpp"
#include "tests/bench/table.hpp"

namespace microtin::bench {
namespace {

struct Total {
  size_t tiles = 0, vertices = 0, bytes = 0;

  void add(const Model& model) {
    ++tiles;
    vertices += model.tin.vertices.size();
    bytes += encode(model.tin, model.metadata).size();
  }
};

Total tiled(const Raster& raster, const LatticeOptions& options, double wanted) {
  Total total;
  for (const Raster& tile : tiles_of(raster, wanted)) total.add(simplified(tile, options));
  return total;
}

std::string increase(const Total& total, const Total& whole) {
  return number(100.0 * static_cast<double>(total.bytes) / static_cast<double>(whole.bytes) - 100,
                1);
}

}  // namespace

void print_tile_rate() {
  const std::vector<Dataset> datasets = rasters();
  if (datasets.empty()) return;
  Row head{"terrain", "vertices", "bytes"};
  for (const char* size : {"1,000", "250"}) {
    head.insert(head.end(), {"tiles of " + std::string(size), "vertices", "bytes", "more, %"});
  }
  print_head("Tiles of the rasters above, same bounds: whole, and in tiles encoded alone", head);
  for (const Dataset& dataset : datasets) {
    const Raster raster = read_raster(dataset);
    Total whole;
    whole.add(simplified(raster, dataset.options));
    Row row{dataset.name, number(whole.vertices), number(whole.bytes)};
    for (const double vertices : {1000.0, 250.0}) {
      const Total total =
          tiled(raster, dataset.options, static_cast<double>(whole.vertices) / vertices);
      row.insert(row.end(), {number(total.tiles), number(total.vertices), number(total.bytes),
                             increase(total, whole)});
    }
    print_row(row);
  }
}

}  // namespace microtin::bench
