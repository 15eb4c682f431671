// SPDX-License-Identifier: MIT
// What is encoded: random points, and the terrains that lie next to the repository.
#ifndef MICROTIN_TESTS_BENCH_INPUTS_HPP
#define MICROTIN_TESTS_BENCH_INPUTS_HPP

#include <string>
#include <vector>

#include "encoder/terrain/lay_out.hpp"
#include "encoder/terrain/survey.hpp"
#include "tests/bench/layers.hpp"

namespace microtin::bench {

// `count` distinct places, uniform on the whole lattice, with z = 0.
Tin uniform_tin(uint32_t count, uint64_t seed);

// A terrain and how it is encoded. Steps and bounds are in metres, xy_step of rasters in posts.
struct Dataset {
  const char* name;
  LatticeOptions options;
};

// Those of the benchmark; none, with a line that says so, where their files are not.
std::vector<Dataset> rasters();
std::vector<Dataset> clouds();

// The centre of a raster: 513 x 513 posts, or all in a direction that has fewer.
Raster read_raster(const Dataset& dataset);
PointCloud read_cloud(const Dataset& dataset);

// The terrain in about `wanted` rectangles, nearly square, that share their border posts; without
// those that are all void.
std::vector<Raster> tiles_of(const Raster& raster, double wanted);

// A source on its lattice: `max_vertices` of its points; or, if that is 0, as few as keep the
// bound, or all where there is none.
struct Model {
  Tin tin;
  Metadata metadata;  // the placement alone
};
Model simplified(const Source& source, const LatticeOptions& options, uint32_t max_vertices = 0);

}  // namespace microtin::bench

#endif
