// Learning of shared/start_probabilities.hpp.
#ifndef MICROTIN_BENCH_TRAIN_HPP
#define MICROTIN_BENCH_TRAIN_HPP

namespace microtin::bench {

// Prints the header with a better table than the one this program is built with: each start moves
// towards where the bit ends, on average over tiles of all kinds. To be repeated until it settles.
void print_start_probabilities();

}  // namespace microtin::bench

#endif
