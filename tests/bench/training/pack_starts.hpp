// SPDX-License-Identifier: MIT
// What a pack would save if all its tiles began with starts of its own.
#ifndef MICROTIN_TESTS_BENCH_TRAINING_PACK_STARTS_HPP
#define MICROTIN_TESTS_BENCH_TRAINING_PACK_STARTS_HPP

namespace microtin::bench {

// Prints, for each raster in tiles of about 1,000 and 250 vertices: bytes of the tiles, and how
// many of them are saved by the best starts for these tiles, less a byte for each start that
// differs.
void print_pack_starts();

}  // namespace microtin::bench

#endif
