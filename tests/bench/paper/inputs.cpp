// SPDX-License-Identifier: MIT
#include "tests/bench/paper/inputs.hpp"

#include <cmath>

#include "tests/bench/layers.hpp"
#include "tests/support/point_sets.hpp"

namespace microtin::bench {
namespace {

constexpr uint32_t kSide = 65536;

uint32_t root(uint32_t count) {
  return static_cast<uint32_t>(std::lround(std::sqrt(count)));
}

Points uniform(uint32_t count) {
  return uniform_places(count, 0);
}

// Each cluster is a square half filled.
Points clustered(uint32_t count) {
  constexpr uint32_t kClusters = 50;
  Random random(0);
  return clustered_points(count, random, kClusters, root(2 * count / kClusters));
}

Points lattice(uint32_t count) {
  Random random(0);
  const uint32_t side = root(count);
  return lattice_points(side, side, random, 100, kSide / side);
}

// Vertical lines with at most every second place taken.
Points few_lines(uint32_t count) {
  Random random(0);
  const uint32_t lines = std::max(3u, count / (kSide / 2) + 1);
  Points points;
  for (uint32_t i = 0; i < count; ++i) {
    points.push_back(point((i % lines) * (kSide - 1) / (lines - 1), random.below(kSide)));
  }
  return distinct(points, random);
}

// A point at an angle, rounded.
Point polar(double radius, double angle) {
  return point(std::llround(32767.5 + radius * std::cos(angle)),
               std::llround(32767.5 + radius * std::sin(angle)));
}

// One circle as long as that holds them, then more inside it.
Points circles(uint32_t count) {
  constexpr uint32_t kOnOne = 100000;
  Random random(0);
  const uint32_t rings = (count + kOnOne - 1) / kOnOne;
  Points points;
  for (uint32_t i = 0; i < count; ++i) {
    const double radius = 32767.0 - 300.0 * (i % rings);
    points.push_back(polar(radius, 2 * std::acos(-1.0) * i / count));
  }
  return distinct(points, random);
}

// Equal steps along a spiral whose arms are ten steps apart.
Points spiral_places(uint32_t count) {
  Random random(0);
  const double turns = std::sqrt(count / (10 * std::acos(-1.0)));
  Points points;
  for (uint32_t i = 0; i < count; ++i) {
    const double part = std::sqrt((i + 1.0) / count);
    points.push_back(polar(32767 * part, 2 * std::acos(-1.0) * turns * part));
  }
  return distinct(points, random);
}

}  // namespace

std::vector<Point> uniform_places(uint32_t count, uint64_t seed) {
  Random random(seed);
  Points points;
  do {
    while (points.size() < count) points.push_back(point_in(random, kSide));
    points = distinct(std::move(points), random);
  } while (points.size() < count);
  return points;
}

const std::vector<Family>& families() {
  static const std::vector<Family> all = {
      {"uniform", uniform},     {"clustered", clustered}, {"lattice", lattice},
      {"few lines", few_lines}, {"circles", circles},     {"spiral", spiral_places},
  };
  return all;
}

}  // namespace microtin::bench
