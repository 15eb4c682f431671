// SPDX-License-Identifier: MIT
// What the adaptive bits of a stream were asked to code.
#ifndef MICROTIN_TESTS_BENCH_TRAINING_OUTCOMES_HPP
#define MICROTIN_TESTS_BENCH_TRAINING_OUTCOMES_HPP

#include <array>
#include <cstdint>
#include <vector>

#include "shared/models.hpp"

namespace microtin::bench {

// What each adaptive bit learned from, one after the other, in the order of Models.
using Outcomes = std::array<std::vector<bool>, kStarts>;

// The stream must be one of our own.
Outcomes outcomes_of(const std::vector<uint8_t>& stream);

}  // namespace microtin::bench

#endif
