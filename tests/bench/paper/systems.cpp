// SPDX-License-Identifier: MIT
#include "tests/bench/paper/systems.hpp"

#include <algorithm>

#include "encoder/stream/fingerprint.hpp"
#include "tests/bench/paper/independent_sets.hpp"

namespace microtin::bench {
namespace {

uint64_t fingerprint_of(const Mesh& mesh) {
  std::vector<Vertex> vertices(mesh.vertices);
  for (Index v = 0; v < mesh.vertices; ++v) {
    const Point at = point_of(mesh, v);
    vertices[v] = {at.x, at.y, 0};
  }
  Fingerprint fingerprint(vertices);
  for (Index t = 0; t < mesh.triangles; ++t) {
    const Index* const v = mesh.origin + first_edge(t);
    const bool removed = v[0] == v[1];
    if (!removed && !is_ghost(v[0], v[1], v[2])) fingerprint.add(v[0], v[1], v[2], false);
  }
  return fingerprint.sum();
}

// Fingerprints of the triangulation before each phase of the removal, coarsest first.
std::vector<uint64_t> fingerprints(Triangulation& triangulation, const Order& order) {
  std::vector<uint64_t> sums;
  for (auto batch = order.batches.rbegin(); batch != order.batches.rend(); ++batch) {
    sums.push_back(fingerprint_of(triangulation.mesh()));
    for (auto v = batch->rbegin(); v != batch->rend(); ++v) {
      triangulation.remove(*v, Triangulation::kMaxRemovable);
    }
  }
  std::reverse(sums.begin(), sums.end());
  return sums;
}

}  // namespace

Order order_of(Triangulation& triangulation, const System& system) {
  if (!system.independent_sets) return breadth_first_order(triangulation, system.degree);
  return independent_set_order(triangulation, system.degree, *system.independent_sets);
}

Sequence sequence_of(const std::vector<Point>& points, const System& system) {
  std::vector<Index> numbers;
  Triangulation triangulation(points, numbers);
  const Order order = order_of(triangulation, system);
  return sequence_of(order, triangulation.mesh());
}

Check check(const std::vector<Point>& points, const System& system) {
  std::vector<Index> numbers;
  Triangulation triangulation(points, numbers), again(points, numbers);
  const Order order = order_of(triangulation, system);
  const std::vector<uint64_t> expected = fingerprints(again, order);
  Check check;
  const auto compare = [&](const Mesh& mesh) {
    if (fingerprint_of(mesh) != expected[check.phases]) ++check.wrong_phases;
    const double batch = static_cast<double>(order.batches[check.phases].size());
    check.least_fraction = std::min(check.least_fraction, batch / (mesh.vertices - 3));
    ++check.phases;
  };
  const Method method = {system.independent_sets, Traversal::kAllNeighbours};
  check.violations = rebuild(sequence_of(order, again.mesh()), method, compare).violations;
  return check;
}

}  // namespace microtin::bench
