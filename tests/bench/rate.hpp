// SPDX-License-Identifier: MIT
// The tables of file sizes; each prints one.
#ifndef MICROTIN_TESTS_BENCH_RATE_HPP
#define MICROTIN_TESTS_BENCH_RATE_HPP

namespace microtin::bench {

void print_uniform_rate();
void print_terrain_rate();
void print_tile_rate();

}  // namespace microtin::bench

#endif
