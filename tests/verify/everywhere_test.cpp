// SPDX-License-Identifier: MIT
// Distances from the bilinear surface of posts: known ones, and dense samples in floating point.
#include "encoder/verify/everywhere.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "encoder/terrain/exact_query.hpp"
#include "tests/support/packs.hpp"
#include "tests/support/point_sets.hpp"
#include "tests/support/streams.hpp"

using namespace microtin::tests;

namespace {

constexpr int64_t kV = kVoidHeight;

struct Found {
  double below = 0, above = 0;
  void add(double difference) {  // of the posts' surface from the triangles'
    below = std::max(below, difference);
    above = std::max(above, -difference);
  }
};

// A raster, and a surface over it whose lattice is coarser or finer than the posts.
struct Case {
  Raster raster;
  Placement lattice;
  Tin tin;
  double places = 1;  // steps of the lattice for each post
  double z_step = 1;
};

// The bilinear surface at a place in posts, if the four posts around it have heights.
std::optional<double> bilinear(const Raster& raster, double x, double y) {
  const double column = std::min(std::floor(x), raster.width - 2.0);
  const double row = std::min(std::floor(y), raster.height - 2.0);
  if (column < 0 || row < 0) return std::nullopt;
  std::array<double, 4> posts{};
  for (size_t i = 0; i < 4; ++i) {
    const size_t at =
        (static_cast<size_t>(row) + i / 2) * raster.width + static_cast<size_t>(column) + i % 2;
    if (raster.heights[at] == kV) return std::nullopt;
    posts[i] = static_cast<double>(raster.heights[at]) / std::pow(10.0, raster.decimals);
  }
  const double p = x - column, q = y - row;
  return (posts[0] * (1 - p) + posts[1] * p) * (1 - q) + (posts[2] * (1 - p) + posts[3] * p) * q;
}

struct Corner {
  double x, y, z;
};

Corner between(const Corner& a, const Corner& b, double t) {
  return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

// Calls visit with the corners of each real triangle, in posts and units of height.
template <class Visit>
void for_each_real(const microtin_mesh* mesh, const Case& c, const Visit& visit) {
  for (uint32_t t = 0; t < microtin_mesh_triangle_count(mesh); ++t) {
    uint32_t v[3];
    if (microtin_mesh_triangle(mesh, t, v) != MICROTIN_TRIANGLE_REAL) continue;
    std::array<Corner, 3> corners{};
    for (size_t i = 0; i < 3; ++i) {
      const microtin::Vertex vertex = vertex_of(mesh, v[i]);
      corners[i] = {vertex.x / c.places, vertex.y / c.places, vertex.z * c.z_step};
    }
    visit(corners);
  }
}

void sample(const Case& c, const Corner& at, Found& found) {
  const std::optional<double> posts = bilinear(c.raster, at.x, at.y);
  if (posts) found.add(*posts - at.z);
}

// Also on both sides of each line between posts, where the bilinear surface has a kink.
std::vector<double> places_along(const Corner& a, const Corner& b) {
  std::vector<double> places;
  for (int n = 0; n <= 840; ++n) places.push_back(n / 840.0);
  for (int line = 0; line < 64; ++line) {
    for (const double t : {(line - a.x) / (b.x - a.x), (line - a.y) / (b.y - a.y)}) {
      if (t > 1e-6 && t < 1 - 1e-6) places.insert(places.end(), {t - 1e-9, t + 1e-9});
    }
  }
  return places;
}

Found sampled_on_edges(const microtin_mesh* mesh, const Case& c) {
  Found found;
  for_each_real(mesh, c, [&](const std::array<Corner, 3>& corners) {
    for (size_t i = 0; i < 3; ++i) {
      const Corner &a = corners[i], &b = corners[(i + 1) % 3];
      for (const double t : places_along(a, b)) sample(c, between(a, b, t), found);
    }
  });
  return found;
}

Found sampled_inside(const microtin_mesh* mesh, const Case& c) {
  Found found;
  constexpr int kSteps = 60;
  for_each_real(mesh, c, [&](const std::array<Corner, 3>& corners) {
    for (int i = 0; i <= kSteps; ++i) {
      const Corner from = between(corners[0], corners[1], i / double{kSteps});
      const Corner to = between(corners[0], corners[2], i / double{kSteps});
      for (int j = 0; j <= kSteps; ++j) sample(c, between(from, to, j / double{kSteps}), found);
    }
  });
  return found;
}

// At posts that lie on the surface.
Found at_posts(const microtin_mesh* mesh, const Case& c) {
  Found found;
  for_each_real(mesh, c, [&](const std::array<Corner, 3>& k) {
    const double area =
        (k[1].x - k[0].x) * (k[2].y - k[0].y) - (k[2].x - k[0].x) * (k[1].y - k[0].y);
    for (uint32_t row = 0; row < c.raster.height; ++row) {
      for (uint32_t column = 0; column < c.raster.width; ++column) {
        const double x = column - k[0].x, y = row - k[0].y;
        const double s = (x * (k[2].y - k[0].y) - y * (k[2].x - k[0].x)) / area;
        const double t = (y * (k[1].x - k[0].x) - x * (k[1].y - k[0].y)) / area;
        const int64_t post = c.raster.heights[size_t{row} * c.raster.width + column];
        if (s < -1e-9 || t < -1e-9 || s + t > 1 + 1e-9 || post == kV) continue;
        const double z = k[0].z + s * (k[1].z - k[0].z) + t * (k[2].z - k[0].z);
        found.add(static_cast<double>(post) / std::pow(10.0, c.raster.decimals) - z);
      }
    }
  });
  return found;
}

Distances measured(const DecodedTerrain& terrain, const Case& c) {
  const std::optional<Distances> found = measure_everywhere(terrain.mesh(), c.lattice, c.raster);
  REQUIRE(found);
  return *found;
}

// Rough heights, some void; vertices at some places of the lattice, corners among them.
Case random_case(Random& random, uint32_t posts_per_step, uint32_t steps_per_post, int decimals) {
  Case c;
  const uint32_t side = 13;
  std::vector<int64_t> heights(size_t{side} * side);
  for (int64_t& z : heights) z = random.below(12) == 0 ? kV : int64_t{random.below(4000)} - 2000;
  c.raster = raster_of(side, heights);
  c.raster.decimals = decimals;
  c.raster.x = {700, 3, 2};
  c.raster.y = {-11, 5, 4};
  c.lattice.x = {700, 3 * posts_per_step, 2 * steps_per_post};
  c.lattice.y = {-11, 5 * posts_per_step, 4 * steps_per_post};
  c.lattice.x.offset *= steps_per_post;
  c.lattice.y.offset *= steps_per_post;
  c.lattice.z = {0, 3, 7};
  c.places = static_cast<double>(steps_per_post) / posts_per_step;
  c.z_step = 3.0 / 7;
  const uint32_t last = (side - 1) * steps_per_post / posts_per_step;
  std::set<std::pair<uint32_t, uint32_t>> places = {{0, 0}, {0, last}, {last, 0}, {last, last}};
  while (places.size() < 20) places.insert({random.below(last + 1), random.below(last + 1)});
  for (const auto& [x, y] : places) {
    const auto z = static_cast<int16_t>(int(random.below(800)) - 400);
    c.tin.vertices.push_back({static_cast<uint16_t>(x), static_cast<uint16_t>(y), z});
  }
  return c;
}

DecodedTerrain decoded(const Case& c) {
  Metadata metadata;
  metadata.placement = c.lattice;
  return DecodedTerrain(encode(c.tin, metadata));
}

}  // namespace

TEST_CASE("everywhere: a saddle of four posts is one off in the middle of its diagonal") {
  Case c;
  c.tin.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 4}};
  c.raster = raster_of(2, {0, 0, 0, 4});
  const Distances found = measured(decoded(c), c);
  CHECK(real(found.below) + real(found.above) == doctest::Approx(1));
  CHECK(std::min(real(found.below), real(found.above)) == 0);
}

TEST_CASE("everywhere: a plane has no distance, and a lifted one the same everywhere") {
  Case c;
  c.tin.vertices = {{0, 0, 0}, {4, 0, 8}, {0, 4, 4}, {4, 4, 12}};
  c.raster =
      raster_of(5, {0, 2, 4, 6, 8, 1, 3, 5, 7, 9, 2, 4, 6, 8, 10, 3, 5, 7, 9, 11, 4, 6, 8, 10, 12});
  Distances found = measured(decoded(c), c);
  CHECK(to_string(found.below) == "0");
  CHECK(to_string(found.above) == "0");
  for (int64_t& height : c.raster.heights) height += 3;
  found = measured(decoded(c), c);
  CHECK(to_string(found.below) == "3");
  CHECK(to_string(found.above) == "0");
}

TEST_CASE("everywhere: cells with a void post are left out, but not their other posts") {
  Case c;
  c.tin.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 1, 0}, {2, 1, 0}, {1, 2, 0}, {2, 2, 4}};
  c.raster = raster_of(3, {0, 0, 0, 0, 0, 0, 0, 0, 4});
  Distances found = measured(decoded(c), c);
  CHECK(real(found.below) + real(found.above) == doctest::Approx(1));  // in the cell of the 4
  c.raster.heights[5] = kV;
  found = measured(decoded(c), c);
  CHECK(real(found.below) + real(found.above) == 0);
  c.raster.heights[8] = 5;
  CHECK(to_string(measured(decoded(c), c).below) == "1");
}

TEST_CASE("everywhere: distances are those of dense samples, and none inside is larger") {
  Random random(38);
  const std::array<std::array<uint32_t, 2>, 5> scales = {{{1, 1}, {2, 1}, {3, 1}, {1, 2}, {2, 5}}};
  for (int round = 0; round < 40; ++round) {
    const auto [posts_per_step, steps_per_post] =
        scales[static_cast<size_t>(round) % scales.size()];
    const Case c = random_case(random, posts_per_step, steps_per_post, round % 3);
    CAPTURE(round);
    const DecodedTerrain terrain = decoded(c);
    const Distances all = measured(terrain, c);
    const Found edges = sampled_on_edges(terrain.mesh(), c), posts = at_posts(terrain.mesh(), c);
    const Found inside = sampled_inside(terrain.mesh(), c);
    const double below = std::max(edges.below, posts.below),
                 above = std::max(edges.above, posts.above);
    // A sample is at most 1/1680 of an edge from the largest difference of a parabola.
    const double slack = 8000 / std::pow(10.0, c.raster.decimals) / 10000 + 1e-4;
    CHECK(real(all.below) >= below - 1e-6);
    CHECK(real(all.below) <= below + slack);
    CHECK(real(all.above) >= above - 1e-6);
    CHECK(real(all.above) <= above + slack);
    CHECK(real(all.below) >= inside.below - 1e-6);
    CHECK(real(all.above) >= inside.above - 1e-6);
  }
}

TEST_CASE("everywhere: nothing is measured where exact numbers would be too large") {
  Case c;
  c.tin.vertices = {{0, 0, 0}, {4, 0, 8}, {0, 4, 4}, {4, 4, 12}};
  c.raster = raster_of(2, {0, 0, 0, 4});
  c.raster.x = {1, 10000019, 9999991};
  const DecodedTerrain terrain = decoded(c);
  CHECK_FALSE(measure_everywhere(terrain.mesh(), c.lattice, c.raster));
  c.raster.x = {0, 1, 1};
  CHECK(measure_everywhere(terrain.mesh(), c.lattice, c.raster));
  c.raster.heights[1] =
      100000000000;  // a height far beyond the lattice is not taken for a nearer one
  CHECK_FALSE(measure_everywhere(terrain.mesh(), c.lattice, c.raster));
}
