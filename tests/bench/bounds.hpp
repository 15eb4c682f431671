// SPDX-License-Identifier: MIT
// Files of guaranteed error: tables and curves.
#ifndef MICROTIN_TESTS_BENCH_BOUNDS_HPP
#define MICROTIN_TESTS_BENCH_BOUNDS_HPP

#include <string>

namespace microtin::bench {

// Bytes at a bound, compared with what compressors of rasters were found to need.
void print_bounds();

// Bytes against bound and against rms error of three rasters, as a drawing (.svg).
void draw_curves(const std::string& path);

}  // namespace microtin::bench

#endif
