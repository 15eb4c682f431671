#include <algorithm>
#include <optional>

#include "encoder/encode.hpp"
#include "encoder/error.hpp"
#include "tests/bench/inputs.hpp"
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

// Tiles in a row or column of `posts` posts that share their border posts: where the i-th begins.
uint32_t border(uint32_t posts, uint32_t tiles, uint32_t i) {
  return static_cast<uint32_t>(uint64_t{posts - 1} * i / tiles);
}

bool has_terrain(const Raster& raster) {
  return std::any_of(raster.heights.begin(), raster.heights.end(),
                     [](int64_t z) { return z != kVoidHeight; });
}

// The terrain in about `wanted` rectangles, nearly square, each encoded alone.
Total tiled(const Raster& raster, const LatticeOptions& options, double wanted) {
  const double aspect = static_cast<double>(raster.width) / raster.height;
  const auto count = [](double n) { return static_cast<uint32_t>(std::max(1.0, std::round(n))); };
  const uint32_t columns = count(std::sqrt(wanted * aspect)), rows = count(wanted / columns);
  Total total;
  for (uint32_t j = 0; j < rows; ++j) {
    for (uint32_t i = 0; i < columns; ++i) {
      const Raster tile =
          crop(raster, {border(raster.width, columns, i), border(raster.height, rows, j),
                        border(raster.width, columns, i + 1), border(raster.height, rows, j + 1)});
      if (has_terrain(tile)) total.add(simplified(tile, options));
    }
  }
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
