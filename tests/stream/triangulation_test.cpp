// SPDX-License-Identifier: MIT
#include "encoder/stream/triangulation.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <string>
#include <utility>

#include "encoder/base/error.hpp"
#include "tests/support/mesh_checks.hpp"
#include "tests/support/point_sets.hpp"
#include "tests/support/reference_delaunay.hpp"
#include "tests/support/slow.hpp"

namespace microtin::tests {
namespace {

// The points of the vertices that were not removed.
Points live_points(const Triangulation& triangulation) {
  Points points;
  for (Index v = 0; v < triangulation.mesh().vertices; ++v) {
    if (triangulation.has_vertex(v)) points.push_back(point_of(triangulation.mesh(), v));
  }
  return points;
}

bool on_one_line(const Points& points) {
  for (const Point p : points) {
    if (orient2d(points[0], points[1], p) != 0) return false;
  }
  return true;
}

// Empty, or what is wrong with the mesh or with what is known of its vertices.
std::string fault(const Triangulation& triangulation) {
  const Mesh& mesh = triangulation.mesh();
  std::string fault = mesh_fault(mesh, static_cast<Index>(live_points(triangulation).size()));
  for (Index v = 0; v < mesh.vertices && fault.empty(); ++v) {
    if (triangulation.has_vertex(v) && mesh.origin[triangulation.edge_of(v)] != v) {
      fault = "a vertex does not know its edge";
    }
  }
  if (mesh.origin[triangulation.edge_of(kInfinity)] != kInfinity) fault = "infinity is lost";
  return fault;
}

// All that attempts on a triangulation depend on.
struct State {
  std::vector<Index> origin, twin, edges;
  Points points;

  bool operator==(const State& other) const {
    return origin == other.origin && twin == other.twin && edges == other.edges &&
           points == other.points;
  }
};

State state_of(const Triangulation& triangulation) {
  const Mesh& mesh = triangulation.mesh();
  State state{{mesh.origin, mesh.origin + first_edge(mesh.triangles)},
              {mesh.twin, mesh.twin + first_edge(mesh.triangles)},
              {},
              live_points(triangulation)};
  for (Index v = 0; v < mesh.vertices; ++v) state.edges.push_back(triangulation.edge_of(v));
  state.edges.push_back(triangulation.edge_of(kInfinity));
  return state;
}

// Whether no neighbour of v is infinity.
bool is_inside(const Triangulation& triangulation, Index v) {
  const Mesh& mesh = triangulation.mesh();
  const Index start = triangulation.edge_of(v);
  Index h = start;
  do {
    if (mesh.origin[next_in_triangle(h)] == kInfinity) return false;
    h = mesh.twin[previous_in_triangle(h)];
  } while (h != start);
  return true;
}

// Whether it equals the triangulation built at once from the points it has now.
bool equals_fresh(const Triangulation& triangulation) {
  const Triangulation fresh(live_points(triangulation));
  return triangles_of(triangulation.mesh()) == triangles_of(fresh.mesh());
}

}  // namespace

TEST_CASE("triangulation: small sets equal the definition") {
  std::vector<PointSet> sets = tiny_point_sets();
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    for (const uint32_t n : {10u, 16u, 25u}) {
      for (PointSet& set : point_sets(n, seed)) sets.push_back(std::move(set));
    }
  }
  for (const PointSet& set : sets) {
    CAPTURE(set.name);
    const Triangulation triangulation(set.points);
    CHECK(fault(triangulation) == "");
    CHECK((triangles_of(triangulation.mesh()) == reference_delaunay(set.points)));
  }
}

TEST_CASE("triangulation: larger sets have no conflict" * kSlow) {
  for (const PointSet& set : point_sets(1200, 1)) {
    CAPTURE(set.name);
    const Triangulation triangulation(set.points);
    CHECK(fault(triangulation) == "");
    CHECK(is_reference_delaunay(set.points, triangles_of(triangulation.mesh())));
  }
}

TEST_CASE("triangulation: every subset of a 3 x 3 lattice") {
  for (uint32_t chosen = 0; chosen < 512; ++chosen) {
    Points points;
    for (uint32_t i = 0; i < 9; ++i) {
      if ((chosen >> i & 1u) != 0) points.push_back(point(i / 3, i % 3));
    }
    if (points.size() < 2 || on_one_line(points)) {
      CHECK_THROWS_AS(Triangulation{points}, Error);
    } else {
      const Triangulation triangulation(points);
      CHECK(fault(triangulation) == "");
      CHECK((triangles_of(triangulation.mesh()) == reference_delaunay(points)));
    }
  }
}

TEST_CASE("triangulation: points without a triangle are refused") {
  Points line;
  for (int64_t i = 0; i < 1000; ++i) line.push_back(point(3 * i, 60000 - 2 * i));
  CHECK_THROWS_WITH_AS(Triangulation{line}, "all points lie on one line: there is no triangle",
                       Error);
  CHECK_THROWS_AS(Triangulation{Points()}, Error);
}

TEST_CASE("triangulation: vertex numbers are those of the input, in any order") {
  Random random(4);
  for (PointSet& set : point_sets(300, 2)) {
    CAPTURE(set.name);
    const TriangleSet expected = triangles_of(Triangulation(set.points).mesh());
    shuffle(set.points, random);
    const Triangulation triangulation(set.points);
    CHECK((triangles_of(triangulation.mesh()) == expected));
    bool same = true;
    for (Index v = 0; v < set.points.size(); ++v) {
      same = same && point_of(triangulation.mesh(), v) == set.points[v];
    }
    CHECK(same);
  }
}

TEST_CASE("triangulation: degrees count infinity and add up to the half-edges") {
  Random random(5);
  const Triangulation triangulation(lattice_points(9, 5, random));
  CHECK(triangulation.degree(kInfinity) == 24);
  Index sum = triangulation.degree(kInfinity);
  for (Index v = 0; v < 45; ++v) sum += triangulation.degree(v);
  CHECK(sum == first_edge(triangulation.mesh().triangles));
}

TEST_CASE("triangulation: a place is located from every half-edge") {
  Random random(6);
  for (const PointSet& set : point_sets(40, 3)) {
    CAPTURE(set.name);
    const Triangulation triangulation(set.points);
    const Mesh& mesh = triangulation.mesh();
    std::size_t wrong = 0;
    for (Index hint = 0; hint < first_edge(mesh.triangles); ++hint) {
      const Point p = hint % 2 == 0
                          ? point_in(random, 65536)
                          : set.points[random.below(static_cast<uint32_t>(set.points.size()))];
      const Index t = triangle_of(triangulation.locate(p, hint));
      const Index ghost = infinite_edge(mesh, t);
      for (Index h = first_edge(t); h < first_edge(t) + 3u; ++h) {
        const Index end = mesh.origin[next_in_triangle(h)];
        if (mesh.origin[h] == kInfinity || end == kInfinity) continue;
        const int64_t side = orient2d(point_of(mesh, mesh.origin[h]), point_of(mesh, end), p);
        if (side < 0 || (side == 0 && ghost != kInfinity)) ++wrong;
      }
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("triangulation: inserting one by one gives the same as all at once") {
  Random random(7);
  std::vector<PointSet> sets = point_sets(200, 4);
  for (PointSet& set : tiny_point_sets()) sets.push_back(std::move(set));
  for (const PointSet& set : sets) {
    CAPTURE(set.name);
    Points first(set.points.begin(), set.points.begin() + 3);
    while (on_one_line(first)) first.push_back(set.points[first.size()]);
    Triangulation triangulation(first);
    for (std::size_t i = first.size(); i < set.points.size(); ++i) {
      const Mesh& mesh = triangulation.mesh();
      const Index hint = random.below(first_edge(mesh.triangles));
      const Index v = triangulation.insert(set.points[i], hint);
      CHECK(v == i);
      CHECK(triangulation.new_triangles().size() == triangulation.degree(v));
    }
    CHECK(fault(triangulation) == "");
    CHECK(equals_fresh(triangulation));
  }
}

TEST_CASE("triangulation: removal gives what the other points alone would give") {
  Random random(8);
  std::vector<PointSet> sets = tiny_point_sets();
  for (uint64_t seed = 5; seed < 10; ++seed) {
    for (const uint32_t n : {10u, 20u, 60u}) {
      for (PointSet& set : point_sets(n, seed)) sets.push_back(std::move(set));
    }
  }
  for (const PointSet& set : sets) {
    CAPTURE(set.name);
    Triangulation triangulation(set.points);
    std::vector<Index> victims;
    for (Index v = 0; v < set.points.size(); ++v) victims.push_back(v);
    shuffle(victims, random);
    for (const Index v : victims) {
      Points rest;
      for (const Point p : live_points(triangulation)) {
        if (p != set.points[v]) rest.push_back(p);
      }
      if (rest.size() < 3 || on_one_line(rest)) continue;
      const Index degree = triangulation.degree(v);
      CHECK(!triangulation.remove(v, std::min(degree - 1, Triangulation::kMaxRemovable)));
      if (degree > Triangulation::kMaxRemovable) continue;
      REQUIRE(triangulation.remove(v, degree));
      CHECK(!triangulation.has_vertex(v));
      REQUIRE(fault(triangulation) == "");
      REQUIRE(equals_fresh(triangulation));
    }
  }
}

TEST_CASE("triangulation: removal leaves all other half-edges alone") {
  Random random(9);
  const Points points = lattice_points(20, 20, random, 80);
  Triangulation triangulation(points);
  const Mesh& mesh = triangulation.mesh();
  const Index slots = mesh.triangles;
  for (Index v = 0; v < points.size(); v += 3) {
    std::vector<bool> around(slots);
    const Index start = triangulation.edge_of(v);
    Index h = start;
    do {
      around[triangle_of(h)] = true;
      h = mesh.twin[previous_in_triangle(h)];
    } while (h != start);
    const std::vector<Index> origin(mesh.origin, mesh.origin + first_edge(slots));
    REQUIRE(triangulation.remove(v, Triangulation::kMaxRemovable));
    bool same = true;
    for (Index e = 0; e < first_edge(slots); ++e) {
      same = same && (around[triangle_of(e)] || mesh.origin[e] == origin[e]);
    }
    CHECK(same);
  }
  CHECK(fault(triangulation) == "");
  CHECK(equals_fresh(triangulation));
}

TEST_CASE("triangulation: points come and go") {
  Random random(11);
  for (PointSet& set : point_sets(60, 12)) {
    CAPTURE(set.name);
    Triangulation triangulation(set.points);
    std::set<Point> outside;
    for (int round = 0; round < 60; ++round) {
      const auto v = random.below(triangulation.mesh().vertices);
      const bool corner = triangulation.has_vertex(v) && live_points(triangulation).size() < 20;
      if (triangulation.has_vertex(v) && !corner && random.below(2) == 0) {
        const Point p = point_of(triangulation.mesh(), v);
        if (triangulation.degree(kInfinity) < 5 || !triangulation.remove(v, 32)) continue;
        outside.insert(p);
      } else if (!outside.empty()) {
        const Point p = *outside.begin();
        outside.erase(outside.begin());
        const Index hint = triangulation.edge_of(kInfinity);
        const std::size_t replaced = triangulation.conflicts(p, hint).size();
        const Index inserted = triangulation.insert(p, hint);
        CHECK(triangulation.degree(inserted) == replaced + 2);
        CHECK(triangulation.new_triangles().size() == replaced + 2);
      }
      REQUIRE(fault(triangulation) == "");
      REQUIRE(equals_fresh(triangulation));
    }
    CHECK(triangulation.mesh().vertices == set.points.size());
  }
}

TEST_CASE("triangulation: degenerate sets take no longer than others") {
  // Quadratic work on these would take minutes.
  Random random(10);
  for (const Points& points :
       {line_and_point(30000, random), two_lines(60000, random), spiral(60000, random),
        lattice_points(2, 50000, random), lattice_points(250, 250, random)}) {
    const Triangulation triangulation(points);
    CHECK(triangulation.mesh().vertices == points.size());
  }
}

TEST_CASE("triangulation: what is undone leaves every number as it was") {
  for (const PointSet& set : point_sets(300, 21)) {
    CAPTURE(set.name);
    if (on_one_line(set.points)) continue;
    Triangulation triangulation(set.points);
    triangulation.log_changes();
    Random random(5);
    Points removed;  // they come back in the same attempt or in a later one
    for (int attempt = 0; attempt < 40; ++attempt) {
      const State before = state_of(triangulation);
      const Points removed_before = removed;
      int changes = 0;
      for (int i = 0; i < 6; ++i) {
        const Index v = random.below(triangulation.mesh().vertices);
        if (random.below(2) == 0 && triangulation.has_vertex(v) && is_inside(triangulation, v) &&
            triangulation.remove(v, Triangulation::kMaxRemovable)) {
          removed.push_back(point_of(triangulation.mesh(), v));
          ++changes;
        } else if (!removed.empty()) {
          triangulation.insert(removed.back(), triangulation.edge_of(kInfinity));
          removed.pop_back();
          ++changes;
        }
      }
      if (attempt % 4 == 0) {
        triangulation.forget_changes();
        continue;
      }
      for (; changes > 0; --changes) triangulation.undo();
      removed = removed_before;
      REQUIRE(fault(triangulation) == "");
      REQUIRE((state_of(triangulation) == before));
    }
    CHECK(equals_fresh(triangulation));
  }
}

}  // namespace microtin::tests
