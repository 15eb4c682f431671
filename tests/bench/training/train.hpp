// SPDX-License-Identifier: MIT
// Learning of shared/start_probabilities.hpp.
#ifndef MICROTIN_TESTS_BENCH_TRAINING_TRAIN_HPP
#define MICROTIN_TESTS_BENCH_TRAINING_TRAIN_HPP

namespace microtin::bench {

// Prints the header with the starts that cost least, each bit alone, over tiles of all kinds. It is
// the same whatever table this program is built with, but for bits that no tile uses: they keep
// their starts.
void print_start_probabilities();

}  // namespace microtin::bench

#endif
