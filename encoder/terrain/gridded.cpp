// SPDX-License-Identifier: MIT
// Rows and columns are as far apart as the common divisor of all distances says.
#include "encoder/terrain/gridded.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "encoder/base/error.hpp"
#include "encoder/exact/fraction.hpp"

namespace microtin::terrain {
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
         std::to_string(raster->height) +
         ", and take about half the bytes as one (on the command line by --gridded)";
}

}  // namespace microtin::terrain
