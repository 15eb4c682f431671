// SPDX-License-Identifier: MIT
// What the points of a cloud are: some share a place of the lattice, some are a raster.
#include "encoder/terrain/clouds.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/exact/lattice_map.hpp"

namespace microtin::terrain {
namespace {

struct Placed {
  Wide x, y;
  uint32_t point;

  bool shares_place_with(const Placed& other) const { return x == other.x && y == other.y; }
};

std::vector<Placed> sorted_by_place(const PointCloud& cloud, const Placement& lattice) {
  const Axis numbers = decimal_axis(cloud.xy_decimals);
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

// The least bound of points, which holds for the one that stands for all.
int64_t least_number(const PointCloud& cloud, const Placed* first, const Placed* end) {
  int64_t least = kUnbounded;
  for (const Placed* one = first; one != end; ++one) {
    const int64_t number = cloud.bounds.numbers[one->point];
    if (number != kUnbounded && (least == kUnbounded || number < least)) least = number;
  }
  return least;
}

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
  thin.bounds = frame_of(cloud.bounds);
  Group group;
  for (size_t i = 0; i < placed.size();) {
    const Placed& first = placed[i];
    group.clear();
    for (; i < placed.size() && placed[i].shares_place_with(first); ++i) {
      group.push_back(cloud.points[placed[i].point]);
    }
    thin.points.push_back(one_of(group, rule));
    if (cloud.bounds.empty()) continue;
    thin.bounds.numbers.push_back(least_number(cloud, &first, &first + group.size()));
  }
  if (thin.points.size() == cloud.points.size()) return std::nullopt;
  return thin;
}

namespace {

// Places on one axis, in numbers of a cloud.
struct Posts {
  int64_t first = 0, step = 0;
  uint64_t count = 0;  // 0: fewer than three, or too many

  uint64_t number(int64_t place) const { return static_cast<uint64_t>((place - first) / step); }
};

// `most`: posts.
Posts posts_on(const PointCloud& cloud, int64_t SourcePoint::*place, uint64_t most) {
  Posts posts;
  if (cloud.points.empty()) return posts;
  int64_t last = posts.first = cloud.points[0].*place;
  for (const SourcePoint& point : cloud.points) {
    posts.first = std::min(posts.first, point.*place);
    last = std::max(last, point.*place);
  }
  for (const SourcePoint& point : cloud.points) {  // numbers are below 2^60
    posts.step = std::gcd(posts.step, point.*place - posts.first);
  }
  const int64_t steps = posts.step == 0 ? 0 : (last - posts.first) / posts.step;
  if (steps >= 2 && static_cast<uint64_t>(steps) < most) {
    posts.count = static_cast<uint64_t>(steps) + 1;
  }
  return posts;
}

struct PointGrid {
  Posts x, y;
};

// At least half of the posts are points.
std::optional<PointGrid> grid_of(const PointCloud& cloud) {
  const uint64_t most = 2 * uint64_t{cloud.points.size()};
  const PointGrid grid{posts_on(cloud, &SourcePoint::x, most),
                       posts_on(cloud, &SourcePoint::y, most)};
  if (grid.x.count == 0 || grid.y.count == 0 || grid.y.count > most / grid.x.count) {
    return std::nullopt;
  }
  return grid;
}

Axis axis_of(const Posts& posts, int decimals) {
  return reduced_axis(posts.first, posts.step, power_of_ten(decimals));
}

}  // namespace

std::optional<Raster> gridded(const PointCloud& cloud) {
  const std::optional<PointGrid> grid = grid_of(cloud);
  if (!grid) return std::nullopt;
  Raster raster;
  try {
    raster.x = axis_of(grid->x, cloud.xy_decimals);
    raster.y = axis_of(grid->y, cloud.xy_decimals);
  } catch (const Error&) {  // no header holds such places
    return std::nullopt;
  }
  raster.width = static_cast<uint32_t>(grid->x.count);
  raster.height = static_cast<uint32_t>(grid->y.count);
  raster.decimals = cloud.z_decimals;
  raster.reference = cloud.reference;
  raster.selection = cloud.selection;
  raster.heights.assign(grid->x.count * grid->y.count, kVoidHeight);
  for (const SourcePoint& point : cloud.points) {
    int64_t& height =
        raster.heights[grid->y.number(point.y) * grid->x.count + grid->x.number(point.x)];
    if (height != kVoidHeight) return std::nullopt;
    height = point.z;
  }
  return raster;
}

std::string warning_on_grid(const PointCloud& cloud) {
  const std::optional<Raster> raster = gridded(cloud);
  if (!raster) return "";
  return "the points are the posts of a raster, " + std::to_string(raster->width) + " x " +
         std::to_string(raster->height) + "; encoded as a raster they take about half the bytes";
}

}  // namespace microtin::terrain
