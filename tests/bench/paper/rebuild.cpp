// SPDX-License-Identifier: MIT
#include "tests/bench/paper/rebuild.hpp"

#include <algorithm>

#include "encoder/base/error.hpp"
#include "shared/insertion.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/paper/walk.hpp"

namespace microtin::bench {
namespace {

class Rebuilder {
 public:
  Rebuilder(const Sequence& sequence, const Method& method);

  void restore(uint32_t batch);
  const Mesh& mesh() const { return mesh_; }
  const Tests& tests() const { return tests_; }

 private:
  // A side of the cavity, by the half-edge beyond it.
  struct Side {
    Index across;
    bool in_front;  // whether the next point is known to lie on the cavity's side
  };

  // Tests.
  bool in_circle(Index h);
  bool sidedness(Index a, Index b, Point p);
  bool destroyed(Side& side);
  bool destroyed_by_sides(Side& side);

  // Insertion.
  void grow_cavity(Index chord);
  Index insert(Index chord);
  void add_triangle(const Side& side);

  // Algorithm 1.
  void scan_triangles();

  // Algorithm 2.
  void walk_breadth_first();
  void turn(Index into);
  void turn_by_sides(Index into);
  Index in_front_of_next(Index into, Index first);
  void finish_around(Index into);

  bool by_sides() const { return method_.traversal == Traversal::kSidedness; }
  bool batch_complete() const { return mesh_.vertices == batch_end_; }
  Point next() const { return sequence_.points[mesh_.vertices]; }
  bool certified(Index h) const { return certified_[triangle_of(h)] == phase_; }
  void certify(Index h) { certified_[triangle_of(h)] = phase_; }
  Index clockwise(Index into) const { return mesh_.twin[next_in_triangle(into)]; }
  Index edge_of_first() const {
    return static_cast<Index>(std::find(origin_.begin(), origin_.end(), Index{0}) -
                              origin_.begin());
  }

  const Sequence& sequence_;
  const Method method_;
  Tests tests_;

  Mesh mesh_{};
  std::vector<Point> places_;
  std::vector<Index> origin_, twin_;
  Index batch_end_ = 0;
  uint32_t phase_ = 0;
  std::vector<uint32_t> certified_;  // by triangle: the last phase in which it was

  std::vector<Index> cavity_triangles_, cavity_origin_, cavity_twin_;
  std::vector<Side> ahead_;        // sides to be looked at, the next one last
  std::vector<uint32_t> visited_;  // entry v + 1: the last phase in which the walk met v
  std::vector<Index> queue_;       // half-edges parent -> vertex
};

Rebuilder::Rebuilder(const Sequence& sequence, const Method& method)
    : sequence_(sequence), method_(method) {
  const size_t n = sequence.points.size();
  places_.resize(n);
  origin_.resize(6 * n);
  twin_.resize(6 * n);
  certified_.resize(2 * n);
  visited_.resize(n + 1);
  queue_.reserve(n);
  for (Index i = 0; i < 3; ++i) places_[i] = sequence.points[i];
  mesh_.place = places_.data();
  mesh_.origin = origin_.data();
  mesh_.twin = twin_.data();
  start_mesh(mesh_);
}

void Rebuilder::restore(uint32_t batch) {
  batch_end_ = static_cast<Index>(mesh_.vertices + batch);
  ++phase_;
  if (method_.independent_sets) {
    scan_triangles();
  } else {
    walk_breadth_first();
  }
  if (!batch_complete()) throw Error("points are left over at the end of a phase");
}

// --- Tests ---------------------------------------------------------------------------------------

// Whether the next point lies in the circle of the triangle of h.
bool Rebuilder::in_circle(Index h) {
  const Index f = first_edge(triangle_of(h));
  const Index a = origin_[f], b = origin_[f + 1], c = origin_[f + 2];
  ++(by_sides() && is_ghost(a, b, c) ? tests_.sidedness : tests_.in_circle);
  return in_conflict(mesh_, a, b, c, next());
}

// Whether p lies to the left of a -> b or on it.
bool Rebuilder::sidedness(Index a, Index b, Point p) {
  ++tests_.sidedness;
  return orient2d(point_of(mesh_, a), point_of(mesh_, b), p) >= 0;
}

// Whether the next point destroys the triangle across a side of its cavity. Certified ones stay.
bool Rebuilder::destroyed(Side& side) {
  const Index f = first_edge(triangle_of(side.across));
  if (certified(side.across)) {
    if (method_.traversal == Traversal::kAllNeighbours && in_circle(side.across)) {
      ++tests_.violations;
    }
    return false;
  }
  const bool ghost = is_ghost(origin_[f], origin_[f + 1], origin_[f + 2]);
  return by_sides() && !ghost ? destroyed_by_sides(side) : in_circle(side.across);
}

// The cavity is star-shaped: the next point sees all of it. So the triangle across is destroyed if
// the point lies on its side, and stays if the point, on the other side, does not see its far
// corner between both ends of the side.
bool Rebuilder::destroyed_by_sides(Side& side) {
  const Index to = origin_[side.across], from = origin_[next_in_triangle(side.across)];
  const Index far = origin_[previous_in_triangle(side.across)];
  if (!side.in_front) {
    if (!sidedness(from, to, next())) return true;
    side.in_front = true;
  }
  return !sidedness(far, from, next()) && !sidedness(to, far, next()) && in_circle(side.across);
}

// --- Insertion -----------------------------------------------------------------------------------

void Rebuilder::add_triangle(const Side& side) {
  const Index h = side.across;
  cavity_triangles_.push_back(triangle_of(h));
  ahead_.push_back({twin_[previous_in_triangle(h)], side.in_front});
  ahead_.push_back({twin_[next_in_triangle(h)], side.in_front});
}

// Finds the triangles that the next point destroys, by a traversal from the one of `chord`, which
// is known to be one of them; `chord` comes first on the boundary if the one across stays.
void Rebuilder::grow_cavity(Index chord) {
  cavity_triangles_.clear();
  cavity_origin_.clear();
  cavity_twin_.clear();
  ahead_.clear();
  add_triangle({chord, false});
  ahead_.push_back({twin_[chord], false});
  while (!ahead_.empty()) {
    Side side = ahead_.back();
    ahead_.pop_back();
    if (destroyed(side)) {
      add_triangle(side);
    } else {
      cavity_origin_.push_back(origin_[next_in_triangle(side.across)]);
      cavity_twin_.push_back(side.across);
    }
  }
}

// Inserts the next point, which destroys the triangle of `chord`. Returns the half-edge between the
// same vertices as `chord` if the triangle across stays.
Index Rebuilder::insert(Index chord) {
  grow_cavity(chord);
  const size_t size = cavity_triangles_.size();
  tests_.destroyed += size;
  cavity_triangles_.resize(size + 2);
  const Cavity cavity = {cavity_triangles_.data(), cavity_origin_.data(), cavity_twin_.data(),
                         static_cast<Index>(size), static_cast<Index>(size)};
  const Index v = mesh_.vertices++;
  places_[v] = sequence_.points[v];
  return fan_cavity(mesh_, cavity, v);
}

// --- Algorithm 1 ---------------------------------------------------------------------------------

// Triangles of the independent points are disjoint: the list stays valid while they are replaced,
// and the new ones are certain.
void Rebuilder::scan_triangles() {
  const Index start = edge_to_infinity(mesh_, edge_of_first());
  for (const Index h : triangles_in_order(mesh_, start, *method_.independent_sets)) {
    if (batch_complete()) return;
    if (certified(h)) continue;
    if (in_circle(h)) {
      insert(h);
      for (const Index triangle : cavity_triangles_) certified_[triangle] = phase_;
    } else {
      certify(h);
    }
  }
}

// --- Algorithm 2 ---------------------------------------------------------------------------------

void Rebuilder::walk_breadth_first() {
  queue_.clear();
  visited_[0] = phase_;
  turn(edge_to_infinity(mesh_, edge_of_first()));
  for (size_t i = 0; i < queue_.size() && !batch_complete(); ++i) {
    if (by_sides()) {
      turn_by_sides(queue_[i]);
    } else {
      turn(queue_[i]);
    }
  }
}

// Restores the neighbourhood of the vertex where `into` ends, clockwise from there.
void Rebuilder::turn(Index into) {
  const Index first = origin_[into];
  do {
    if (!certified(into) && !batch_complete() && in_circle(into)) into = insert(into);
    certify(into);
    into = clockwise(into);
  } while (origin_[into] != first);
  finish_around(into);
}

// Turns by sidedness tests. The next point becomes a neighbour of the vertex if and only if it
// destroys the triangle in front of which it lies, as seen from the vertex: that is found by
// sidedness, and is the only one whose circle is asked for.
void Rebuilder::turn_by_sides(Index into) {
  const Index first = origin_[into], vertex = origin_[next_in_triangle(into)];
  for (;;) {
    const Index h = in_front_of_next(into, first);
    if (h == kInfinity || !in_circle(h)) break;
    insert(h);
    const auto at = std::find(cavity_origin_.begin(), cavity_origin_.end(), vertex);
    const auto i = static_cast<size_t>(at - cavity_origin_.begin());
    into = first_edge(cavity_triangles_[i]) + 2u;  // from the new vertex
    certify(twin_[into]);
  }
  while (origin_[into] != first) into = clockwise(into);
  finish_around(into);
}

// The half-edge, clockwise from `into` to `first`, of the triangle that is not certified and in
// front of which the next point lies; kInfinity if there is none.
Index Rebuilder::in_front_of_next(Index into, Index first) {
  if (batch_complete()) return kInfinity;
  const Index vertex = origin_[next_in_triangle(into)];
  bool known = false, inside = false;  // to the left of the side at which the turn is
  do {
    if (certified(into)) {
      known = false;
    } else {
      if (!known) inside = sidedness(origin_[into], vertex, next());
      const bool before = sidedness(vertex, origin_[previous_in_triangle(into)], next());
      if (inside && before) return into;
      known = true;
      inside = !before;
    }
    into = clockwise(into);
  } while (origin_[into] != first);
  return kInfinity;
}

// All triangles around the vertex are certain; its neighbours join the next level of the tree.
void Rebuilder::finish_around(Index into) {
  const Index start = into;
  do {
    certify(into);
    uint32_t& visited = visited_[static_cast<Index>(origin_[into] + 1u)];
    if (visited != phase_) queue_.push_back(twin_[into]);
    visited = phase_;
    into = clockwise(into);
  } while (into != start);
}

}  // namespace

Tests rebuild(const Sequence& sequence, const Method& method, const PhaseEnd& phase_end) {
  Rebuilder rebuilder(sequence, method);
  for (const uint32_t batch : sequence.batches) {
    rebuilder.restore(batch);
    if (phase_end) phase_end(rebuilder.mesh());
  }
  return rebuilder.tests();
}

}  // namespace microtin::bench
