// SPDX-License-Identifier: MIT
// A terrain that the program makes itself, for demonstrations and tests.
#ifndef MICROTIN_ENCODER_TERRAIN_FRACTAL_HPP
#define MICROTIN_ENCODER_TERRAIN_FRACTAL_HPP

#include <cstdint>
#include <ostream>
#include <vector>

#include "encoder/layers.hpp"

namespace microtin::terrain {

constexpr uint32_t kSmallestFractal = 2, kLargestFractal = 8193;  // posts a side

// Heights in metres of size x size posts, row 0 southernmost: mountains cut by rivers, in a sea of
// height 0. Computed with integers only, so a seed gives the same terrain everywhere.
std::vector<int16_t> fractal_heights(uint32_t size, uint64_t seed);

// Writes the fractal as an ESRI ASCII grid, posts 30 m apart.
void write_fractal_asc(std::ostream& out, uint32_t size, uint64_t seed);

}  // namespace microtin::terrain

#endif
