// SPDX-License-Identifier: MIT
// Terrain rasters with their real size, and what a regular grid makes of them.
#ifndef MICROTIN_TESTS_BENCH_GRIDS_GRID_HPP
#define MICROTIN_TESTS_BENCH_GRIDS_GRID_HPP

#include <string>
#include <vector>

#include "tests/bench/inputs.hpp"

namespace microtin::bench {

// Heights are numbers of units of `z_metres`.
struct Terrain {
  std::string name;
  Raster raster;
  LatticeOptions options;  // as in the tables of rates
  double column_metres, row_metres, z_metres;

  double square_kilometres() const {
    return (raster.width - 1) * column_metres * (raster.height - 1) * row_metres / 1e6;
  }
};

// Those that lie next to the repository, each once; else one that the program makes itself.
std::vector<Terrain> terrains();

// Heights of a grid in metres, bilinear in between.
class Grid {
 public:
  // Samples a terrain every `spacing` metres from its south-western post on, rounded to multiples
  // of `step` metres.
  Grid(const Terrain& terrain, double spacing, double step);

  // At a place in metres from that post; NaN next to voids.
  double height_at(double x, double y) const;

 private:
  double spacing_;
  size_t columns_, rows_;
  std::vector<double> heights_;  // row by row; NaN where unknown
};

struct Errors {
  double largest = 0, rms = 0;  // in metres
};

// At all posts for which the grid has a height.
Errors errors_of(const Grid& grid, const Terrain& terrain);

}  // namespace microtin::bench

#endif
