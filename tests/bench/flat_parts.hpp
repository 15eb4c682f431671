// SPDX-License-Identifier: MIT
// How far a terrain is off where its source is flat.
#ifndef MICROTIN_TESTS_BENCH_FLAT_PARTS_HPP
#define MICROTIN_TESTS_BENCH_FLAT_PARTS_HPP

#include <optional>
#include <vector>

#include "encoder/terrain/source.hpp"
#include "tests/bench/layers.hpp"

namespace microtin::bench {

// Flat parts are connected posts of one height, more than a twentieth of all with a height. Given
// the error of each post, the mean error of the part where it is farthest from zero; nothing if
// there is no such part.
std::optional<double> worst_flat_mean(const Raster& raster, const std::vector<double>& errors);

}  // namespace microtin::bench

#endif
