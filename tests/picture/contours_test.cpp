// SPDX-License-Identifier: MIT
// Contours against the planes of the triangles, and by their shapes.
#include <doctest/doctest.h>

#include <cmath>
#include <map>

#include "encoder/base/error.hpp"
#include "encoder/picture/map_lines.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/point_sets.hpp"
#include "tests/support/slow.hpp"

using namespace microtin;
using namespace microtin::tests;

namespace {

// A square of posts, each cell cut into two triangles.
template <class Height>
SurfaceModel grid_model(int64_t side, const Height& height) {
  SurfaceModel model;
  for (int64_t y = 0; y < side; ++y) {
    for (int64_t x = 0; x < side; ++x) model.vertices.push_back({x, y, height(x, y)});
  }
  const auto number = [side](int64_t x, int64_t y) { return static_cast<uint32_t>(y * side + x); };
  for (int64_t y = 0; y + 1 < side; ++y) {
    for (int64_t x = 0; x + 1 < side; ++x) {
      model.triangles.push_back({number(x, y), number(x + 1, y), number(x, y + 1)});
      model.triangles.push_back({number(x + 1, y), number(x + 1, y + 1), number(x, y + 1)});
    }
  }
  return model;
}

// The height of the plane of the cell's triangle at a place.
double height_at(const SurfaceModel& model, int64_t side, Spot at) {
  const auto x = std::min<int64_t>(static_cast<int64_t>(at.x), side - 2),
             y = std::min<int64_t>(static_cast<int64_t>(at.y), side - 2);
  const auto z = [&](int64_t i, int64_t j) {
    return static_cast<double>(model.vertices[static_cast<size_t>((y + j) * side + x + i)][2]);
  };
  const double u = at.x - static_cast<double>(x), v = at.y - static_cast<double>(y);
  return u + v <= 1 ? z(0, 0) + u * (z(1, 0) - z(0, 0)) + v * (z(0, 1) - z(0, 0))
                    : z(1, 1) + (1 - u) * (z(0, 1) - z(1, 1)) + (1 - v) * (z(1, 0) - z(1, 1));
}

bool is_closed(const Contour& contour) {
  return contour.places.front().x == contour.places.back().x &&
         contour.places.front().y == contour.places.back().y;
}

}  // namespace

TEST_CASE("contours: lie on the surface at their heights, and end at borders alone") {
  constexpr int64_t kSide = 24;
  Random random(7);
  SurfaceModel model = grid_model(kSide, [&](int64_t, int64_t) -> int64_t {
    return static_cast<int64_t>(random.below(41)) - 20;
  });
  model.placement.z = {-3, 1, 4};  // quarters, from -0.75 on
  const Decimal interval{15, 1};
  size_t pieces = 0;
  for (const Contour& contour : contours_of(model, interval)) {
    pieces += contour.places.size() - 1;
    for (size_t i = 0; i + 1 < contour.places.size(); ++i) {
      const Spot a = contour.places[i], b = contour.places[i + 1];
      for (const double t : {0.0, 0.37, 0.5, 1.0}) {
        const Spot at{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
        CHECK((height_at(model, kSide, at) - 3) / 4 ==
              doctest::Approx(1.5 * static_cast<double>(contour.level)).epsilon(1e-9));
      }
    }
    if (is_closed(contour)) continue;
    for (const Spot end : {contour.places.front(), contour.places.back()}) {
      CHECK((end.x == 0 || end.y == 0 || end.x == kSide - 1 || end.y == kSide - 1));
    }
  }
  // Each triangle has a piece for each multiple in the heights from its lowest, without, to
  // highest.
  size_t expected = 0;
  for (const auto& triangle : model.triangles) {
    std::array<int64_t, 3> z{};
    for (size_t i = 0; i < 3; ++i) z[i] = model.vertices[triangle[i]][2];
    for (int64_t level = -20; level <= 20; ++level) {
      const int64_t step = 6 * level + 3;
      expected += step >= *std::min_element(z.begin(), z.end()) &&
                  step < *std::max_element(z.begin(), z.end());
    }
  }
  CHECK(pieces == expected);
}

TEST_CASE("contours: a cone has one closed line a level, a slope one open line") {
  const SurfaceModel cone = grid_model(41, [](int64_t x, int64_t y) {
    return 100 - 4 * std::max(std::abs(x - 20), std::abs(y - 20));
  });
  std::map<int64_t, int> lines;
  for (const Contour& contour : contours_of(cone, {10, 0})) {
    CHECK(is_closed(contour));
    ++lines[contour.level];
  }
  CHECK(lines ==
        std::map<int64_t, int>{{2, 1}, {3, 1}, {4, 1}, {5, 1}, {6, 1}, {7, 1}, {8, 1}, {9, 1}});
  const SurfaceModel slope = grid_model(9, [](int64_t x, int64_t) { return 3 * x; });
  const std::vector<Contour> open = contours_of(slope, {7, 0});
  CHECK(open.size() == 4);  // 0, 7, 14, 21
  for (const Contour& contour : open) CHECK(!is_closed(contour));
}

TEST_CASE("contours: the line around a lake is its shore") {
  const SurfaceModel lake = grid_model(11, [](int64_t x, int64_t y) {
    return std::max<int64_t>(0, std::abs(x - 5) + std::abs(y - 5) - 2);
  });
  size_t shores = 0;
  for (const Contour& contour : contours_of(lake, {100, 0})) {
    ++shores;
    CHECK(contour.level == 0);
    for (const Spot at : contour.places) CHECK(std::abs(at.x - 5) + std::abs(at.y - 5) <= 2);
  }
  CHECK(shores == 1);
  CHECK(contours_of(grid_model(5, [](int64_t, int64_t) { return 50; }), {50, 0}).empty());
}

TEST_CASE("contours: intervals are round, and too many lines are refused" * kSlow) {
  CHECK(!round_interval(5, 5));
  CHECK(*round_interval(0, 100) == Decimal{10, 0});
  CHECK(*round_interval(420, 3108) == Decimal{200, 0});
  CHECK(*round_interval(-52.74, -51.06) == Decimal{1, 1});
  CHECK(*round_interval(0, 0.5) == Decimal{5, 2});
  SurfaceModel steep = grid_model(2, [](int64_t x, int64_t) { return 30000 * x; });
  CHECK_THROWS_WITH_AS(contours_of(steep, {1, 3}),
                       "the interval of contours is too small; use a larger one", Error);
  steep.placement.z = {INT64_MAX, (uint64_t{1} << 40) - 1, 1};
  CHECK_THROWS_AS(contours_of(steep, {1, 9}), Error);
}
