// SPDX-License-Identifier: MIT
// The grids that flight controllers use now, against meshes of equal error.
#ifndef MICROTIN_TESTS_BENCH_GRIDS_FIRMWARE_GRIDS_HPP
#define MICROTIN_TESTS_BENCH_GRIDS_FIRMWARE_GRIDS_HPP

namespace microtin::bench {

void print_firmware_grids();

}  // namespace microtin::bench

#endif
