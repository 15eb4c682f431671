// SPDX-License-Identifier: MIT
#include "tests/bench/grids/grid.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "encoder/terrain/fractal.hpp"
#include "tests/bench/layers.hpp"

namespace microtin::bench {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

Terrain synthetic() {
  constexpr uint32_t kSize = 513;
  constexpr double kSpacing = 30;
  Terrain terrain{"synthetic", {},       {{}, parse_decimal("8"), parse_decimal("10")},
                  kSpacing,    kSpacing, 1};
  terrain.raster.width = terrain.raster.height = kSize;
  for (const int16_t z : fractal_heights(kSize, 1)) terrain.raster.heights.push_back(z);
  return terrain;
}

Terrain terrain_of(const Dataset& dataset) {
  const std::string path = std::string(MICROTIN_DATA_DIR) + "/" + dataset.name + ".json";
  const auto description = nlohmann::json::parse(std::ifstream(path));
  return {dataset.name,
          read_raster(dataset),
          dataset.options,
          description.at("cell_x_m"),
          description.at("cell_y_m"),
          description.at("z_unit_m")};
}

// The value between four that are `columns` in a row, at a place counted in columns and rows.
template <class Value>
double bilinear(size_t columns, size_t rows, double x, double y, const Value& value) {
  const auto cell = [](double at, size_t posts) {
    return static_cast<size_t>(std::clamp(at, 0.0, static_cast<double>(posts - 2)));
  };
  const size_t i = cell(x, columns), j = cell(y, rows);
  const double u = std::min(1.0, x - static_cast<double>(i));
  const double v = std::min(1.0, y - static_cast<double>(j));
  const auto along = [&](size_t row) {
    return (1 - u) * value(row * columns + i) + u * value(row * columns + i + 1);
  };
  return (1 - v) * along(j) + v * along(j + 1);
}

double metres(const Terrain& terrain, size_t post) {
  const int64_t z = terrain.raster.heights[post];
  return z == kVoidHeight ? kUnknown : static_cast<double>(z) * terrain.z_metres;
}

}  // namespace

std::vector<Terrain> terrains() {
  std::vector<Terrain> all;
  for (const Dataset& dataset : rasters()) {
    if (all.empty() || all.back().name != dataset.name) all.push_back(terrain_of(dataset));
  }
  if (all.empty()) all.push_back(synthetic());
  return all;
}

Grid::Grid(const Terrain& terrain, double spacing, double step) : spacing_(spacing) {
  const Raster& raster = terrain.raster;
  const auto posts = [spacing](uint32_t count, double cell) {
    return static_cast<size_t>(std::ceil((count - 1) * cell / spacing)) + 1;
  };
  columns_ = posts(raster.width, terrain.column_metres);
  rows_ = posts(raster.height, terrain.row_metres);
  const auto value = [&](size_t post) { return metres(terrain, post); };
  for (size_t j = 0; j < rows_; ++j) {
    for (size_t i = 0; i < columns_; ++i) {
      const double x = static_cast<double>(i) * spacing / terrain.column_metres;
      const double y = static_cast<double>(j) * spacing / terrain.row_metres;
      heights_.push_back(step *
                         std::round(bilinear(raster.width, raster.height, x, y, value) / step));
    }
  }
}

double Grid::height_at(double x, double y) const {
  return bilinear(columns_, rows_, x / spacing_, y / spacing_,
                  [this](size_t post) { return heights_[post]; });
}

Errors errors_of(const Grid& grid, const Terrain& terrain) {
  Errors errors;
  double squares = 0, posts = 0;
  for (uint32_t row = 0; row < terrain.raster.height; ++row) {
    for (uint32_t column = 0; column < terrain.raster.width; ++column) {
      const double height = metres(terrain, size_t{row} * terrain.raster.width + column);
      const double error = std::abs(
          grid.height_at(column * terrain.column_metres, row * terrain.row_metres) - height);
      if (std::isnan(error)) continue;
      errors.largest = std::max(errors.largest, error);
      squares += error * error;
      posts += 1;
    }
  }
  errors.rms = std::sqrt(squares / posts);
  return errors;
}

}  // namespace microtin::bench
