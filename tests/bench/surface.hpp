// SPDX-License-Identifier: MIT
// What all codecs are given and must give back.
#ifndef MICROTIN_TESTS_BENCH_SURFACE_HPP
#define MICROTIN_TESTS_BENCH_SURFACE_HPP

#include <array>
#include <cstdint>
#include <vector>

#include "shared/lattice.hpp"

namespace microtin::bench {

using Bytes = std::vector<uint8_t>;

struct Surface {
  bool has_heights = false;  // if not, every z is 0 and codecs send x and y alone
  std::vector<Vertex> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;  // those that are not void
};

// What a stream of ours holds.
Surface surface_of(const Bytes& stream);

bool same_vertices(const Surface& a, const Surface& b);

// Whether both have the same triangles, however their vertices are numbered, and whether or not
// some are doubled.
bool same_triangles(const Surface& a, const Surface& b);

// log2 of the number of sets of as many places in the smallest box around them, per vertex: what no
// codec goes below if all sets are as likely.
double floor_bits(const Surface& surface);
double floor_bits(double places, double vertices);

}  // namespace microtin::bench

#endif
