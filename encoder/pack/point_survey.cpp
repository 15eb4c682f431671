// SPDX-License-Identifier: MIT
// Merges points that share a place, and bounds the heights there.
#include <algorithm>
#include <map>

#include "encoder/exact/fraction.hpp"
#include "encoder/pack/point_tiles.hpp"

namespace microtin::pack {
namespace {

constexpr uint32_t kPartBits = 16;

// The points of each square of 2^16 x 2^16 places, by its first place.
std::map<GlobalPost, std::vector<uint32_t>> squares(const std::vector<GlobalPost>& places) {
  std::map<GlobalPost, std::vector<uint32_t>> parts;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const GlobalPost first{places[i].x >> kPartBits << kPartBits,
                           places[i].y >> kPartBits << kPartBits};
    parts[first].push_back(static_cast<uint32_t>(i));
  }
  return parts;
}

Lattice lattice_from(Lattice whole, GlobalPost first) {
  whole.x.shift -= whole.x.step * first.x;
  whole.y.shift -= whole.y.step * first.y;
  whole.placement = placement_from(whole.placement, first);
  return whole;
}

Decimal larger(Decimal a, Decimal b) {
  return a <= b ? b : a;
}

}  // namespace

PointSurvey survey_points(const PointCloud& cloud, const LatticeOptions& options) {
  PointSurvey survey;
  survey.lattice = choose_pack_lattice(cloud, options);
  const auto places = places_on(cloud, survey.lattice.placement, INT32_MAX, INT32_MAX);
  for (const auto& [first, points] : squares(places)) {
    const Laid laid = lay_out(part_of(cloud, points), lattice_from(survey.lattice, first), options);
    for (const Sample& s : laid.survey.samples) {
      survey.samples.push_back(
          {{first.x + s.place.x, first.y + s.place.y}, s.height, s.lowest, s.highest});
    }
    survey.xy_step = laid.xy_step;
    survey.z_step = laid.z_step;
    survey.xy_displacement = larger(survey.xy_displacement, laid.xy_displacement);
    survey.merged += laid.merged;
  }
  std::sort(survey.samples.begin(), survey.samples.end(),
            [](const GlobalSample& a, const GlobalSample& b) { return a.place < b.place; });
  survey.x_max = survey.y_max = 0;
  for (const GlobalSample& s : survey.samples) {
    survey.x_max = std::max(survey.x_max, s.place.x);
    survey.y_max = std::max(survey.y_max, s.place.y);
  }
  return survey;
}

std::vector<GlobalPost> places_of(const std::vector<GlobalSample>& samples) {
  std::vector<GlobalPost> places;
  places.reserve(samples.size());
  for (const GlobalSample& sample : samples) places.push_back(sample.place);
  return places;
}

std::vector<GlobalPost> places_on(const PointCloud& cloud, const Placement& lattice, uint32_t x_max,
                                  uint32_t y_max) {
  const Placement numbers = placement_of(part_of(cloud, {}));
  const LatticeMap x_map = map_between(numbers.x, lattice.x);
  const LatticeMap y_map = map_between(numbers.y, lattice.y);
  std::vector<GlobalPost> places;
  places.reserve(cloud.points.size());
  for (const SourcePoint& p : cloud.points) {
    const Wide x = x_map.nearest(p.x), y = y_map.nearest(p.y);
    const bool inside = x >= 0 && x <= x_max && y >= 0 && y <= y_max;
    places.push_back(inside ? GlobalPost{static_cast<uint32_t>(x), static_cast<uint32_t>(y)}
                            : kNowhere);
  }
  return places;
}

Placement placement_from(const Placement& whole, GlobalPost first) {
  return {moved_axis(whole.x, first.x), moved_axis(whole.y, first.y), whole.z};
}

PointCloud part_of(const PointCloud& cloud, const std::vector<uint32_t>& points) {
  PointCloud part;
  part.xy_decimals = cloud.xy_decimals;
  part.z_decimals = cloud.z_decimals;
  part.points.reserve(points.size());
  for (const uint32_t i : points) part.points.push_back(cloud.points[i]);
  part.bounds = frame_of(cloud.bounds);
  if (!cloud.bounds.empty()) {
    for (const uint32_t i : points) part.bounds.numbers.push_back(cloud.bounds.numbers[i]);
  }
  return part;
}

}  // namespace microtin::pack
