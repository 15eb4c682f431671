// SPDX-License-Identifier: MIT
#include "tests/bench/flat_parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace microtin::bench {
namespace {

// A flat part has more posts than all that have a height, divided by this.
constexpr size_t kShare = 20;

// Adds the posts next to one that have its height and were not met yet.
void spread(const Raster& raster, size_t post, std::vector<bool>& met, std::vector<size_t>& part) {
  const size_t x = post % raster.width;
  const auto visit = [&](bool inside, size_t other) {
    if (!inside || met[other] || raster.heights[other] != raster.heights[post]) return;
    met[other] = true;
    part.push_back(other);
  };
  visit(x != 0, post - 1);
  visit(x + 1 != raster.width, post + 1);
  visit(post >= raster.width, post - raster.width);
  visit(post + raster.width < raster.heights.size(), post + raster.width);
}

}  // namespace

std::optional<double> worst_flat_mean(const Raster& raster, const std::vector<double>& errors) {
  const auto voids = std::count(raster.heights.begin(), raster.heights.end(), kVoidHeight);
  const size_t posts = raster.heights.size() - static_cast<size_t>(voids);
  std::vector<bool> met(raster.heights.size());
  std::optional<double> worst;
  for (size_t first = 0; first < met.size(); ++first) {
    if (met[first] || raster.heights[first] == kVoidHeight) continue;
    met[first] = true;
    std::vector<size_t> part{first};
    for (size_t i = 0; i < part.size(); ++i) spread(raster, part[i], met, part);
    if (part.size() * kShare <= posts) continue;
    double sum = 0;
    for (const size_t post : part) sum += errors[post];
    const double mean = sum / static_cast<double>(part.size());
    if (!worst || std::abs(mean) > std::abs(*worst)) worst = mean;
  }
  return worst;
}

}  // namespace microtin::bench
