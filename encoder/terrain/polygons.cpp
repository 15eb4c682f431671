// SPDX-License-Identifier: MIT
// Cuts rings with rows of posts, exactly.
#include "encoder/terrain/polygons.hpp"

#include <algorithm>
#include <cstddef>

#include "encoder/base/error.hpp"
#include "encoder/exact/wide.hpp"
#include "shared/predicates.hpp"

namespace microtin::terrain {
namespace {

constexpr int64_t kParts = 1024;

// The number at a coordinate, times kParts, to the nearest.
int64_t number_at(Decimal coordinate, const Axis& axis) {
  constexpr Wide kMostProduct = Wide{1} << 62;
  const Wide unit = power_of_ten(coordinate.decimals);
  const Wide above = coordinate.mantissa * static_cast<Wide>(axis.denominator) - axis.offset * unit;
  const Wide under = static_cast<Wide>(axis.numerator) * unit;
  const Wide number = round_divide(above * kParts, under);
  if (magnitude(number) >= kMostProduct) {
    throw Error("the coordinate " + to_string(coordinate) + " is too far from the terrain");
  }
  return static_cast<int64_t>(number);
}

}  // namespace

Rings::Rings(const RealRings& rings, const Axis& x, const Axis& y) {
  for (const RealLine& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const RealPoint &a = ring[i], &b = ring[(i + 1) % ring.size()];
      const Place from{number_at(a.x, x), number_at(a.y, y)};
      const Place to{number_at(b.x, x), number_at(b.y, y)};
      edges_.push_back(from.y <= to.y ? Edge{from, to} : Edge{to, from});
    }
  }
}

std::vector<std::pair<int64_t, int64_t>> Rings::spans(int64_t row) const {
  std::vector<std::pair<int64_t, int64_t>> spans, crossings;  // a crossing: rounded down, and up
  const Wide y = Wide{row} * kParts;
  for (const auto& [low, high] : edges_) {
    if (y < low.y || y > high.y) continue;
    if (low.y == high.y) {
      spans.emplace_back(ceil_divide(std::min(low.x, high.x), kParts),
                         floor_divide(std::max(low.x, high.x), kParts));
      continue;
    }
    const Wide run = Wide{high.y} - low.y;
    const Wide x = low.x * run + (y - low.y) * (Wide{high.x} - low.x);
    const auto before = static_cast<int64_t>(floor_divide(x, run * kParts)),
               behind = static_cast<int64_t>(ceil_divide(x, run * kParts));
    if (before == behind) spans.emplace_back(before, behind);  // on the border
    if (y != high.y) crossings.emplace_back(before, behind);
  }
  std::sort(crossings.begin(), crossings.end());
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
    spans.emplace_back(crossings[i].second, crossings[i + 1].first);
  }
  return spans;
}

bool Rings::contains(int64_t x, int64_t y) const {
  const auto all = spans(y);
  return std::any_of(all.begin(), all.end(),
                     [x](const auto& span) { return span.first <= x && x <= span.second; });
}

std::vector<uint32_t> hull_corners(const std::vector<Point>& places) {
  if (places.empty()) return {};
  const auto n = static_cast<uint32_t>(places.size());
  std::vector<uint32_t> chain;
  // The chain turns to the left from `start` on: what lies behind a new place then goes.
  const auto extend = [&](std::size_t start, uint32_t place) {
    while (chain.size() >= start + 2 &&
           orient2d(places[chain[chain.size() - 2]], places[chain.back()], places[place]) <= 0) {
      chain.pop_back();
    }
    chain.push_back(place);
  };
  for (uint32_t i = 0; i < n; ++i) extend(0, i);
  const std::size_t upper = chain.size() - 1;
  for (uint32_t i = n - 1; i-- > 0;) extend(upper, i);
  chain.pop_back();
  return chain;
}

}  // namespace microtin::terrain
