// SPDX-License-Identifier: MIT
// Sorts points by their places, and takes one of each.
#include "encoder/terrain/duplicates.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "encoder/exact/lattice_map.hpp"

namespace microtin::terrain {
namespace {

struct Placed {
  Wide x, y;
  uint32_t point;

  bool shares_place_with(const Placed& other) const { return x == other.x && y == other.y; }
};

std::vector<Placed> sorted_by_place(const PointCloud& cloud, const Placement& lattice) {
  const Axis numbers{0, 1, static_cast<uint64_t>(power_of_ten(cloud.xy_decimals))};
  const LatticeMap x = map_between(numbers, lattice.x), y = map_between(numbers, lattice.y);
  std::vector<Placed> placed;
  placed.reserve(cloud.points.size());
  for (const SourcePoint& p : cloud.points) {
    placed.push_back({x.nearest(p.x), y.nearest(p.y), static_cast<uint32_t>(placed.size())});
  }
  std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
    if (a.x != b.x) return a.x < b.x;
    return a.y != b.y ? a.y < b.y : a.point < b.point;
  });
  return placed;
}

using Group = std::vector<SourcePoint>;

bool is_lower(const SourcePoint& a, const SourcePoint& b) {
  return a.z < b.z;
}

SourcePoint mean_of(const Group& group) {
  Wide x = 0, y = 0, z = 0;
  for (const SourcePoint& p : group) {
    x += p.x;
    y += p.y;
    z += p.z;
  }
  const auto mean = [&group](Wide sum) {
    return static_cast<int64_t>(round_divide(sum, static_cast<Wide>(group.size())));
  };
  return {mean(x), mean(y), mean(z)};
}

SourcePoint one_of(const Group& group, DuplicateRule rule) {
  if (group.size() == 1) return group[0];
  if (rule == DuplicateRule::kMean) return mean_of(group);
  if (rule == DuplicateRule::kLowest) {
    return *std::min_element(group.begin(), group.end(), is_lower);
  }
  return *std::max_element(group.begin(), group.end(), is_lower);
}

}  // namespace

std::optional<PointCloud> thinned(const PointCloud& cloud, const Placement& lattice,
                                  DuplicateRule rule) {
  const bool thins = rule == DuplicateRule::kLowest || rule == DuplicateRule::kHighest ||
                     rule == DuplicateRule::kMean;
  if (!thins) return std::nullopt;
  const std::vector<Placed> placed = sorted_by_place(cloud, lattice);
  PointCloud thin;
  thin.xy_decimals = cloud.xy_decimals;
  thin.z_decimals = cloud.z_decimals;
  thin.reference = cloud.reference;
  thin.selection = cloud.selection;
  thin.classes = cloud.classes;
  Group group;
  for (size_t i = 0; i < placed.size();) {
    const Placed& first = placed[i];
    group.clear();
    for (; i < placed.size() && placed[i].shares_place_with(first); ++i) {
      group.push_back(cloud.points[placed[i].point]);
    }
    thin.points.push_back(one_of(group, rule));
  }
  if (thin.points.size() == cloud.points.size()) return std::nullopt;
  return thin;
}

}  // namespace microtin::terrain
