// SPDX-License-Identifier: MIT
// A cloud of points on the lattice of a pack, which is wider than that of a stream.
#ifndef MICROTIN_ENCODER_PACK_POINT_SURVEY_HPP
#define MICROTIN_ENCODER_PACK_POINT_SURVEY_HPP

#include <cstdint>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/pack/borders.hpp"
#include "encoder/terrain/lay_out.hpp"

namespace microtin::pack {

// As a Sample, anywhere in the pack.
struct GlobalSample {
  GlobalPost place;
  int32_t height, lowest, highest;
};

struct PointSurvey {
  Lattice lattice;
  uint32_t x_max, y_max;              // of the samples
  std::vector<GlobalSample> samples;  // distinct places, in lexicographic order
  Decimal xy_step, z_step;
  Decimal xy_displacement;  // as in Laid
  uint64_t merged = 0;
};

// Lays the cloud out as lay_out does, but on choose_pack_lattice. Throws Error as these do; places
// where the bound cannot be kept are counted within 2^16 x 2^16 places. O(n log n).
PointSurvey survey_points(const PointCloud& cloud, const LatticeOptions& options);

std::vector<GlobalPost> places_of(const std::vector<GlobalSample>& samples);

// A place that no pack has.
constexpr GlobalPost kNowhere{UINT32_MAX, UINT32_MAX};

// Where the points of a cloud lie on a lattice so placed; kNowhere beyond the largest x and y.
std::vector<GlobalPost> places_on(const PointCloud& cloud, const Placement& lattice, uint32_t x_max,
                                  uint32_t y_max);

// The placement of a part of the lattice whose places count from there. Throws Error if no axis can
// say that.
Placement placement_from(const Placement& whole, GlobalPost first);

// The points with these numbers.
PointCloud part_of(const PointCloud& cloud, const std::vector<uint32_t>& points);

}  // namespace microtin::pack

#endif
