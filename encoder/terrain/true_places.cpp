// SPDX-License-Identifier: MIT
// Asks a terrain between the places of its lattice.
#include "encoder/terrain/true_places.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <vector>

#include "encoder/exact/lattice_map.hpp"
#include "encoder/terrain/error_meter.hpp"

namespace microtin::terrain {
namespace {

constexpr int64_t kBand = 256;  // rows that are asked from west to east together

class TruePlaces {
 public:
  TruePlaces(const Placement& lattice, const PointCloud& cloud) {
    const Axis numbers{0, 1, static_cast<uint64_t>(power_of_ten(cloud.xy_decimals))};
    x_ = map_between(numbers, lattice.x);
    y_ = map_between(numbers, lattice.y);
  }

  RealPlace exact(const SourcePoint& p) const {
    return place_of(coordinate(x_, p.x), coordinate(y_, p.y));
  }
  RealPlace nearest(const SourcePoint& p) const {
    return place_on_lattice(limited(x_.nearest(p.x)), limited(y_.nearest(p.y)));
  }
  bool moves(const SourcePoint& p) const {
    return x_.numerator(p.x) % x_.step != 0 || y_.numerator(p.y) % y_.step != 0;
  }

 private:
  static RealCoordinate coordinate(const LatticeMap& map, int64_t number) {
    const Wide numerator = map.numerator(number), whole = floor_divide(numerator, map.step);
    return {limited(whole), numerator - whole * map.step, map.step};
  }
  // Points of a source that is not the lattice's own may lie anywhere; no terrain goes so far.
  static int64_t limited(Wide place) {
    constexpr Wide kFar = Wide{1} << 62;
    return static_cast<int64_t>(std::clamp(place, -kFar, kFar));
  }

  LatticeMap x_{}, y_{};
};

// The order in which points are asked, so that neighbours follow each other.
std::vector<uint32_t> order_of(const PointCloud& cloud, const TruePlaces& places) {
  std::vector<uint32_t> order(cloud.points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::vector<std::tuple<int64_t, int64_t>> keys;
  keys.reserve(order.size());
  for (const SourcePoint& p : cloud.points) {
    const RealPlace place = places.nearest(p);
    keys.emplace_back(-(place.y / kBand), place.x);
  }
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });
  return order;
}

}  // namespace

bool moves_points(const Placement& lattice, const PointCloud& cloud) {
  const TruePlaces places(lattice, cloud);
  return std::any_of(cloud.points.begin(), cloud.points.end(),
                     [&](const SourcePoint& p) { return places.moves(p); });
}

Verification verify_at_true_places(const HeightQuery& height_at, const Placement& lattice,
                                   const PointCloud& cloud, const std::optional<Decimal>& bound,
                                   const TruePlaceVisitor& visit) {
  const TruePlaces places(lattice, cloud);
  ErrorMeter meter({0, 1, static_cast<uint64_t>(power_of_ten(cloud.z_decimals))}, lattice.z);
  Verification result;
  for (const uint32_t i : order_of(cloud, places)) {
    const SourcePoint& p = cloud.points[i];
    const RealPlace there = places.exact(p), nearest = places.nearest(p);
    ExactAnswer answer = height_at(there);
    if (answer.kind != MICROTIN_QUERY_OK) answer = height_at(nearest);
    ++result.posts;
    if (answer.kind != MICROTIN_QUERY_OK) continue;
    ++result.covered;
    const double above = meter.add(p.z, answer.height);
    if (visit) visit(nearest, there, above);
  }
  result.uncovered = result.posts - result.covered;
  meter.tell(bound, result);
  return result;
}

}  // namespace microtin::terrain
