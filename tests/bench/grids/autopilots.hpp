// SPDX-License-Identifier: MIT
// A flight over a cell of one degree with the adapters of decoder/adapters, and with the
// autopilots' own files.
#ifndef MICROTIN_TESTS_BENCH_GRIDS_AUTOPILOTS_HPP
#define MICROTIN_TESTS_BENCH_GRIDS_AUTOPILOTS_HPP

#include <string>

namespace microtin::bench {

// Writes a synthetic terrain as a cell of SRTM, an .hgt.
void write_cell(const std::string& path);

// The source, a raster in degrees; its pack, and one of small tiles; its grids every 30, 30 and
// 100 m, named after the cell. `callgrind` is as for instructions().
struct AutopilotFiles {
  std::string callgrind, terrain, pack, small_pack, inav, ardupilot_30, ardupilot_100;
};
void print_autopilots(const AutopilotFiles& files);

}  // namespace microtin::bench

#endif
