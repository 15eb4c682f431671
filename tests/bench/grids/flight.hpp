// SPDX-License-Identifier: MIT
// A flight over a terrain with a pack and with a grid: what each takes, and how wrong it is.
#ifndef MICROTIN_TESTS_BENCH_GRIDS_FLIGHT_HPP
#define MICROTIN_TESTS_BENCH_GRIDS_FLIGHT_HPP

#include <string>

namespace microtin::bench {

// Writes the grid of a raster's file as tests/bench/device/grid_file.hpp says, a post every 100 m.
void write_grid(const std::string& terrain, const std::string& grid);

// Prints what the images flight_pack, flight_compact and flight_grid printed, compared with the
// source.
struct FlightFiles {
  std::string terrain, pack, grid, pack_log, compact_log, grid_log;
};
void print_flight(const FlightFiles& files);

}  // namespace microtin::bench

#endif
