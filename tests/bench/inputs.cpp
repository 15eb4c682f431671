// SPDX-License-Identifier: MIT
#include "tests/bench/inputs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "encoder/base/error.hpp"
#include "encoder/fit/simplify.hpp"
#include "encoder/import/import.hpp"
#include "encoder/terrain/raster_reader.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/paper/inputs.hpp"

namespace microtin::bench {
namespace {

constexpr uint32_t kCentre = 513;  // posts
constexpr int kNoData = -32768;

const std::string kFolder = MICROTIN_DATA_DIR;

// The content of a compressed file.
std::string unzipped(const std::string& path) {
  const auto close = [](FILE* pipe) { pclose(pipe); };
  const std::unique_ptr<FILE, decltype(close)> pipe(popen(("gzip -dc '" + path + "'").c_str(), "r"),
                                                    close);
  if (!pipe) throw Error(path + ": cannot run gzip");
  std::string content, block(65536, '\0');
  while (const size_t size = std::fread(block.data(), 1, block.size(), pipe.get())) {
    content.append(block, 0, size);
  }
  return content;
}

std::vector<Dataset> if_present(std::vector<Dataset> datasets, const char* kind) {
  if (!kFolder.empty()) return datasets;
  std::printf("skipped: %s (no data beside the repository)\n", kind);
  return {};
}

LatticeOptions bounded(const char* max_error, const char* z_step) {
  return {{}, parse_decimal(z_step), parse_decimal(max_error)};
}

LatticeOptions unbounded(const char* xy_step, const char* z_step) {
  return {parse_decimal(xy_step), parse_decimal(z_step), {}};
}

PostRectangle centre(uint32_t width, uint32_t height) {
  const uint32_t columns = std::min(width, kCentre), rows = std::min(height, kCentre);
  return {(width - columns) / 2, (height - rows) / 2, columns, rows};
}

}  // namespace

Tin uniform_tin(uint32_t count, uint64_t seed) {
  Tin tin;
  for (const Point p : uniform_places(count, seed)) tin.vertices.push_back({p.x, p.y, 0});
  return tin;
}

std::vector<Dataset> rasters() {
  return if_present(
      {
          {"scottish_borders", bounded("10", "8")},
          {"scottish_borders", bounded("30", "24")},
          {"sthelens", bounded("10", "8")},
          {"osnabrueck", bounded("5", "4")},
          {"bigtujunga", bounded("20", "16")},
          {"jacksboro", bounded("10", "8")},
          {"riviera", bounded("10", "8")},
          {"jd211_multibeam", bounded("0.10", "0.08")},
          {"tidal_marsh", bounded("0.2", "0.16")},
      },
      "rasters");
}

std::vector<Dataset> clouds() {
  return if_present(
      {
          {"delft_ground", unbounded("0.05", "0.05")},
          {"quebec_forest_ground", unbounded("0.05", "0.05")},
          {"delft_urban", unbounded("0.1", "0.05")},
      },
      "clouds");
}

Raster read_raster(const Dataset& dataset) {
  const std::string path = kFolder + "/" + dataset.name;
  const auto description = nlohmann::json::parse(std::ifstream(path + ".json"));
  const std::string bytes = unzipped(path + ".hgt16.gz");
  Raster raster;
  raster.width = description.at("width");
  raster.height = description.at("height");
  raster.decimals = description.at("z_unit_m") == 1 ? 0 : 2;
  if (bytes.size() != size_t{2} * raster.width * raster.height) throw Error(path + ": wrong size");
  for (uint32_t row = raster.height; row-- > 0;) {  // the file begins in the north
    for (uint32_t column = 0; column < raster.width; ++column) {
      const size_t at = 2 * (size_t{row} * raster.width + column);
      const auto low = static_cast<uint8_t>(bytes[at]), high = static_cast<uint8_t>(bytes[at + 1]);
      const auto z = static_cast<int16_t>(low | high << 8);
      raster.heights.push_back(z == kNoData ? kVoidHeight : z);
    }
  }
  return crop(raster, centre(raster.width, raster.height));
}

PointCloud read_cloud(const Dataset& dataset) {
  const std::string path = kFolder + "/" + dataset.name + ".xyz.gz";
  return import_points(path, unzipped(path));
}

namespace {

// Tiles in a row or column of `posts` posts that share their border posts: where the i-th begins.
uint32_t border(uint32_t posts, uint32_t tiles, uint32_t i) {
  return static_cast<uint32_t>(uint64_t{posts - 1} * i / tiles);
}

bool has_terrain(const Raster& raster) {
  return std::any_of(raster.heights.begin(), raster.heights.end(),
                     [](int64_t z) { return z != kVoidHeight; });
}

}  // namespace

std::vector<Raster> tiles_of(const Raster& raster, double wanted) {
  const double aspect = static_cast<double>(raster.width) / raster.height;
  const auto count = [](double n) { return static_cast<uint32_t>(std::max(1.0, std::round(n))); };
  const uint32_t columns = count(std::sqrt(wanted * aspect)), rows = count(wanted / columns);
  std::vector<Raster> tiles;
  for (uint32_t j = 0; j < rows; ++j) {
    for (uint32_t i = 0; i < columns; ++i) {
      const uint32_t x = border(raster.width, columns, i), y = border(raster.height, rows, j);
      Raster tile = crop(raster, {x, y, border(raster.width, columns, i + 1) - x + 1,
                                  border(raster.height, rows, j + 1) - y + 1});
      if (has_terrain(tile)) tiles.push_back(std::move(tile));
    }
  }
  return tiles;
}

Model simplified(const Source& source, const LatticeOptions& options, uint32_t max_vertices) {
  const Laid laid = lay_out(source, options);
  SimplifyOptions simplify_options;
  simplify_options.bounded = max_vertices == 0 && options.max_error;
  simplify_options.max_vertices = max_vertices;
  simplify_options.search = Search::kGreedy;
  Model model{simplify(laid.survey, simplify_options), {}};
  model.metadata.placement = laid.placement;
  return model;
}

}  // namespace microtin::bench
