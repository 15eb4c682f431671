// SPDX-License-Identifier: MIT
// Benchmarks speak of all layers.
#ifndef MICROTIN_TESTS_BENCH_LAYERS_HPP
#define MICROTIN_TESTS_BENCH_LAYERS_HPP

#include "encoder/layers.hpp"
#include "tests/bench/layers.hpp"

namespace microtin::tests {}

namespace microtin::bench {
using namespace product;
using namespace tests;
}  // namespace microtin::bench

#endif
