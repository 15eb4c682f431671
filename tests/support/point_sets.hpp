// SPDX-License-Identifier: MIT
// Point sets, seeded, that are easy or hard for a triangulation. None lies on one line.
#ifndef MICROTIN_TESTS_SUPPORT_POINT_SETS_HPP
#define MICROTIN_TESTS_SUPPORT_POINT_SETS_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "shared/lattice.hpp"
#include "tests/support/layers.hpp"

namespace microtin::tests {

// SplitMix64: the same numbers everywhere.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}

  uint64_t next() {
    uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
  }

  uint32_t below(uint32_t bound) { return static_cast<uint32_t>((next() >> 32) * bound >> 32); }

 private:
  uint64_t state_;
};

using Points = std::vector<Point>;

inline Point point(int64_t x, int64_t y) {
  return Point{static_cast<uint16_t>(x), static_cast<uint16_t>(y)};
}

// A place of a square whose least corner is (x, y). One number after the other: the order in which
// a call's arguments are evaluated is the compiler's choice.
inline Point point_in(Random& random, uint32_t side, int64_t x = 0, int64_t y = 0) {
  const uint32_t dx = random.below(side);
  return point(x + dx, y + random.below(side));
}

template <class T>
void shuffle(std::vector<T>& items, Random& random) {
  for (std::size_t i = items.size(); i > 1; --i) {
    std::swap(items[i - 1], items[random.below(static_cast<uint32_t>(i))]);
  }
}

// Each point once, in a random order.
inline Points distinct(Points points, Random& random) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  shuffle(points, random);
  return points;
}

// --- Generators of about n points --------------------------------------------------------------

inline Points uniform_points(uint32_t n, Random& random, uint32_t side = 65536) {
  Points points;
  for (uint32_t i = 0; i < n; ++i) points.push_back(point_in(random, side));
  return distinct(points, random);
}

inline Points clustered_points(uint32_t n, Random& random, uint32_t clusters, uint32_t width) {
  Points points, centres = uniform_points(clusters, random, 65536 - width);
  for (uint32_t i = 0; i < n; ++i) {
    const Point centre = centres[i % centres.size()];
    points.push_back(point_in(random, width, centre.x, centre.y));
  }
  return distinct(points, random);
}

// Every point of a grid; `keep` of 100 of its points.
inline Points lattice_points(uint32_t columns, uint32_t rows, Random& random, uint32_t keep = 100,
                             uint32_t step = 1) {
  Points points;
  for (uint32_t x = 0; x < columns; ++x) {
    for (uint32_t y = 0; y < rows; ++y) {
      if (random.below(100) < keep) points.push_back(point(x * step, y * step));
    }
  }
  return distinct(points, random);
}

// Every lattice point on a circle in the middle; most for products of primes 4k + 1.
inline Points circle_points(int64_t squared_radius, Random& random) {
  Points points;
  for (int64_t dx = 0; dx * dx <= squared_radius; ++dx) {
    const int64_t rest = squared_radius - dx * dx;
    const int64_t dy = std::llround(std::sqrt(static_cast<double>(rest)));
    if (dy * dy != rest) continue;
    for (const int64_t x : {32767 - dx, 32767 + dx}) {
      for (const int64_t y : {32767 - dy, 32767 + dy}) points.push_back(point(x, y));
    }
  }
  return distinct(points, random);
}

// Many points on the border of a square, and some inside.
inline Points collinear_border(uint32_t n, Random& random) {
  Points points = uniform_points(n / 4, random);
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t along = random.below(65536), end = i % 2 * 65535;
    points.push_back(i % 4 < 2 ? point(along, end) : point(end, along));
  }
  return distinct(points, random);
}

inline Points line_and_point(uint32_t n, Random& random) {
  Points points = {point(40000, 65535)};
  for (uint32_t i = 0; i < n; ++i) points.push_back(point(2 * i, i + 7));
  return distinct(points, random);
}

inline Points two_lines(uint32_t n, Random& random) {
  Points points;
  for (uint32_t i = 0; i < n; ++i) points.push_back(point(i / 2, i % 2 == 0 ? 0 : 65535));
  return distinct(points, random);
}

inline Points parabola(uint32_t n, Random& random) {
  Points points;
  for (int64_t i = 0; i < n && i < 256; ++i) points.push_back(point(i + 100, i * i));
  return distinct(points, random);
}

inline Points spiral(uint32_t n, Random& random) {
  Points points;
  for (uint32_t i = 0; i < n; ++i) {
    const double angle = 0.1 * i, radius = 32000.0 * i / n;
    points.push_back(point(std::llround(32767 + radius * std::cos(angle)),
                           std::llround(32767 + radius * std::sin(angle))));
  }
  return distinct(points, random);
}

// The corners of the lattice and what lies next to them.
inline Points extreme_corners(Random& random) {
  Points points;
  for (const int64_t x : {0, 1, 65534, 65535}) {
    for (const int64_t y : {0, 1, 65534, 65535}) points.push_back(point(x, y));
  }
  points.push_back(point(32767, 32767));
  points.push_back(point(32768, 32767));
  return distinct(points, random);
}

// --- All of them -------------------------------------------------------------------------------

struct PointSet {
  std::string name;
  Points points;
};

inline std::vector<PointSet> tiny_point_sets() {
  return {
      {"triangle", {point(5, 5), point(9, 5), point(5, 6)}},
      {"clockwise triangle", {point(5, 5), point(5, 6), point(9, 5)}},
      {"largest triangle", {point(65535, 65535), point(0, 0), point(0, 65535)}},
      {"square", {point(0, 0), point(1, 0), point(1, 1), point(0, 1)}},
      {"largest square", {point(65535, 0), point(0, 0), point(65535, 65535), point(0, 65535)}},
      {"point in a triangle", {point(0, 0), point(9, 0), point(0, 9), point(2, 2)}},
      {"point on a side", {point(0, 0), point(4, 0), point(8, 0), point(3, 9)}},
      {"square and centre", {point(0, 0), point(2, 0), point(2, 2), point(0, 2), point(1, 1)}},
      {"largest determinant", {point(0, 0), point(65534, 0), point(32767, 32767), point(0, 65534)}},
      {"three on a line and two",
       {point(1, 1), point(2, 2), point(3, 3), point(0, 9), point(9, 0)}},
      {"sliver", {point(0, 0), point(65535, 65534), point(32768, 32767), point(65534, 65533)}},
  };
}

// One set of each kind with about n points, n >= 10; fewer where the kind has not as many.
inline std::vector<PointSet> point_sets(uint32_t n, uint64_t seed) {
  Random random(seed);
  const uint32_t side = static_cast<uint32_t>(std::lround(std::sqrt(n)));
  const uint32_t dense = static_cast<uint32_t>(std::lround(std::sqrt(1.5 * n))) + 1;
  return {
      {"uniform", uniform_points(n, random)},
      {"uniform in a small square", uniform_points(n, random, dense)},
      {"clusters", clustered_points(n, random, 5, 500)},
      {"tight clusters", clustered_points(n, random, 3, dense / 2 + 2)},
      {"lattice", lattice_points(side, side, random)},
      {"wide lattice", lattice_points(side, side, random, 100, 65535 / side)},
      {"half of a lattice", lattice_points(dense, dense, random, 60)},
      {"2 rows", lattice_points(n / 2, 2, random)},
      {"2 columns", lattice_points(2, n / 2, random)},
      {"3 rows", lattice_points(n / 3, 3, random, 100, 3)},
      {"circle", circle_points(n < 100 ? 5 * 5 * 13 * 17 : 5 * 5 * 13 * 13 * 17 * 29 * 37, random)},
      {"collinear border", collinear_border(n, random)},
      {"line and point", line_and_point(n, random)},
      {"two lines", two_lines(n, random)},
      {"parabola", parabola(n, random)},
      {"spiral", spiral(n, random)},
      {"extreme corners", extreme_corners(random)},
  };
}

}  // namespace microtin::tests

#endif
