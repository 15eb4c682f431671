// SPDX-License-Identifier: MIT
// The convex hull of places.
#include "encoder/terrain/convex_hull.hpp"

#include <cstddef>

#include "shared/predicates.hpp"

namespace microtin::terrain {

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
