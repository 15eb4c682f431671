// SPDX-License-Identifier: MIT
// The triangulation of all points of a pack: the Delaunay triangulation, up to 2^31 steps.
#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/pack/point_tiles.hpp"
#include "encoder/stream/triangulation.hpp"
#include "tests/support/point_sets.hpp"

namespace microtin::tests {
namespace {

using Edges = std::set<std::pair<uint32_t, uint32_t>>;

std::pair<uint32_t, uint32_t> ordered(uint32_t a, uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

Edges edges_of(const GlobalTriangulation& triangulation) {
  Edges edges;
  triangulation.visit_edges(
      [&](uint32_t a, uint32_t b) { CHECK(edges.insert(ordered(a, b)).second); });
  return edges;
}

Edges edges_of(const Triangulation& triangulation) {
  const Mesh& mesh = triangulation.mesh();
  Edges edges;
  for (Index h = 0; h < first_edge(mesh.triangles); ++h) {
    const Index a = mesh.origin[h], b = mesh.origin[next_in_triangle(h)];
    if (a != kInfinity && b != kInfinity) edges.insert(ordered(a, b));
  }
  return edges;
}

std::vector<GlobalPost> global(const Points& points, uint32_t scale, uint32_t shift) {
  std::vector<GlobalPost> places;
  for (const Point p : points) places.push_back({p.x * scale + shift, p.y * scale + shift});
  return places;
}

}  // namespace

TEST_CASE("global triangulation: that of streams where no four points lie on a circle") {
  Random random(3);
  for (const uint32_t n : {3u, 4u, 10u, 100u, 3000u}) {
    const Points points = uniform_points(n, random);
    if (points.size() < 3) continue;
    const Edges expected = edges_of(Triangulation(points));
    for (const auto& to : {std::pair(1u, 0u), {1u, 2147418112u}, {32768u, 32767u}}) {
      CAPTURE(n);
      CAPTURE(to.first);
      CHECK(edges_of(GlobalTriangulation(global(points, to.first, to.second))) == expected);
    }
  }
}

TEST_CASE("global triangulation: as many edges where points lie on circles and lines") {
  for (const auto& sets : {tiny_point_sets(), point_sets(30, 5), point_sets(500, 6)}) {
    for (const PointSet& set : sets) {
      CAPTURE(set.name);
      const Edges expected = edges_of(Triangulation(set.points));
      const GlobalTriangulation triangulation(global(set.points, 32767, 0));
      CHECK(edges_of(triangulation).size() == expected.size());
    }
  }
}

TEST_CASE("global triangulation: the order of the points does not matter") {
  Random random(8);
  Points points = lattice_points(20, 20, random);
  const auto named = [](const Points& all) {
    std::set<std::pair<uint32_t, uint32_t>> edges;
    const std::vector<GlobalPost> places = global(all, 7, 0);
    GlobalTriangulation(places).visit_edges(
        [&](uint32_t a, uint32_t b) { edges.insert(ordered(rank_of(all[a]), rank_of(all[b]))); });
    return edges;
  };
  const auto expected = named(points);
  shuffle(points, random);
  CHECK(named(points) == expected);
}

TEST_CASE("global triangulation: points on a line are refused") {
  const std::vector<GlobalPost> line = {{0, 0}, {1, 1}, {2147483647, 2147483647}};
  CHECK_THROWS_WITH_AS(GlobalTriangulation{line},
                       "all points lie on one line: there is no triangle", Error);
  const std::vector<GlobalPost> two = {{0, 0}, {1, 1}};
  CHECK_THROWS_AS(GlobalTriangulation{two}, Error);
}

}  // namespace microtin::tests
