// SPDX-License-Identifier: MIT
#include "tests/bench/paper/independent_sets.hpp"

#include <algorithm>

#include "tests/bench/paper/walk.hpp"

namespace microtin::bench {
namespace {

class IndependentSets {
 public:
  IndependentSets(Triangulation& triangulation, uint32_t degree, Walk walk)
      : triangulation_(triangulation),
        degree_(degree),
        walk_(walk),
        blocked_(triangulation.mesh().vertices),
        owner_(triangulation.mesh().triangles) {}

  // Removes one set and returns it sorted; `kept` stays.
  std::vector<Index> remove_set(const std::array<Index, 3>& kept) {
    std::fill(blocked_.begin(), blocked_.end(), false);
    std::fill(owner_.begin(), owner_.end(), kInfinity);
    for (const Index v : kept) blocked_[v] = true;
    size_t removed = 0;
    for (const std::vector<Index>& vertices : candidates()) {
      for (const Index v : vertices) {
        if (!blocked_[v] && remove(v)) ++removed;
      }
    }
    return sorted(kept[0], removed);
  }

 private:
  // The vertices of each degree.
  std::vector<std::vector<Index>> candidates() const {
    std::vector<std::vector<Index>> by_degree(degree_ + 1);
    for (Index v = 0; v < triangulation_.mesh().vertices; ++v) {
      if (!triangulation_.has_vertex(v)) continue;
      const Index degree = triangulation_.degree(v);
      if (degree <= degree_) by_degree[degree].push_back(v);
    }
    return by_degree;
  }

  // Removes v if it has few neighbours. They are blocked, and the triangles that fill the hole,
  // which take the places of those around v, belong to it.
  bool remove(Index v) {
    const Mesh& mesh = triangulation_.mesh();
    around_.clear();
    const Index start = triangulation_.edge_of(v);
    Index h = start;
    do {
      around_.push_back(h);
      neighbours_[around_.size() - 1] = mesh.origin[next_in_triangle(h)];
      h = mesh.twin[previous_in_triangle(h)];
    } while (h != start && around_.size() <= degree_);
    if (!triangulation_.remove(v, degree_)) return false;
    for (size_t i = 0; i < around_.size(); ++i) {
      owner_[triangle_of(around_[i])] = v;
      if (neighbours_[i] != kInfinity) blocked_[neighbours_[i]] = true;
    }
    return true;
  }

  std::vector<Index> sorted(Index start, size_t removed) {
    const Mesh& mesh = triangulation_.mesh();
    std::vector<Index> batch;
    const Index from = edge_to_infinity(mesh, triangulation_.edge_of(start));
    for (const Index h : triangles_in_order(mesh, from, walk_)) {
      const Index v = owner_[triangle_of(h)];
      if (v == kInfinity || blocked_[v]) continue;
      blocked_[v] = true;
      batch.push_back(v);
      if (batch.size() == removed) break;
    }
    return batch;
  }

  Triangulation& triangulation_;
  const uint32_t degree_;
  const Walk walk_;
  std::vector<bool> blocked_;  // by vertex: kept, a neighbour of the set, or in the batch already
  std::vector<Index> owner_;   // by triangle
  std::vector<Index> around_;
  std::array<Index, Triangulation::kMaxRemovable + 1> neighbours_{};
};

// The smallest vertex and two with which it has a triangle.
std::array<Index, 3> choose_kept(const Triangulation& triangulation) {
  const Mesh& mesh = triangulation.mesh();
  Index least = 0;
  for (Index v = 1; v < mesh.vertices; ++v) {
    if (point_of(mesh, v) < point_of(mesh, least)) least = v;
  }
  // Counter-clockwise around a hull vertex, the ghost whose far corner is infinity comes first.
  const Index h =
      mesh.twin[previous_in_triangle(edge_to_infinity(mesh, triangulation.edge_of(least)))];
  return {least, mesh.origin[next_in_triangle(h)], mesh.origin[previous_in_triangle(h)]};
}

}  // namespace

Order independent_set_order(Triangulation& triangulation, uint32_t degree, Walk walk) {
  Order order;
  order.seed = choose_kept(triangulation);
  IndependentSets sets(triangulation, degree, walk);
  for (Index left = triangulation.mesh().vertices; left > 3;) {
    order.batches.push_back(sets.remove_set(order.seed));
    left -= static_cast<Index>(order.batches.back().size());
  }
  std::reverse(order.batches.begin(), order.batches.end());
  return order;
}

}  // namespace microtin::bench
