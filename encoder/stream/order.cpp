// SPDX-License-Identifier: MIT
// Walks breadth first, again and again, and takes an independent set of vertices away each time.
#include "encoder/stream/order.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "encoder/stream/triangulation.hpp"

namespace microtin::stream {
namespace {

// Memory is requested this many vertices before it is needed: the order is known, and its way
// through memory is long.
constexpr std::size_t kAhead = 8;

// Walks over a triangulation breadth first, again and again while vertices are removed from it.
class Walk {
 public:
  explicit Walk(const Triangulation& triangulation)
      : triangulation_(triangulation), met_(std::size_t{triangulation.mesh().vertices} + 1) {
    vertices_.resize(met_.size());
    arrivals_.resize(met_.size());
  }

  // All vertices but infinity, from infinity by way of `first`; around each vertex clockwise from
  // the edge to its parent.
  const std::vector<Index>& breadth_first(Index first) {
    const Mesh mesh = triangulation_.mesh();
    Index from_infinity = triangulation_.edge_of(kInfinity);
    while (mesh.origin[next_in_triangle(from_infinity)] != first) {
      from_infinity = mesh.twin[previous_in_triangle(from_infinity)];
    }
    const uint8_t walk = ++walks_;
    uint8_t* const met = met_.data();  // entry v + 1; kInfinity + 1 wraps round to entry 0
    Index* const vertices = vertices_.data();
    Index* const arrivals = arrivals_.data();
    met[0] = walk;
    Index arrival = mesh.twin[from_infinity];  // from the parent to the vertex
    std::size_t done = 0, found = 0;
    for (;;) {
      Index into = arrival;
      do {
        const Index neighbour = mesh.origin[into];
        // Written in any case, kept if it is new: nobody can predict which it is.
        vertices[found] = neighbour;
        arrivals[found] = mesh.twin[into];
        uint8_t& mark = met[static_cast<Index>(neighbour + 1u)];
        found += mark != walk;
        mark = walk;
        into = mesh.twin[next_without_branch(into)];
      } while (into != arrival);
      if (done == found) break;
      if (found - done > kAhead) {
        prefetch(mesh.origin + arrivals[done + kAhead]);
        prefetch(mesh.twin + arrivals[done + kAhead]);
      }
      arrival = arrivals[done++];
    }
    vertices_.resize(found);
    return vertices_;
  }

 private:
  const Triangulation& triangulation_;
  std::vector<uint8_t> met_;     // the last walk that met a vertex, of fewer than 64 ("Work")
  std::vector<Index> vertices_;  // found so far
  std::vector<Index> arrivals_;  // and the half-edges to them
  uint8_t walks_ = 0;
};

// The smallest point, the largest, and the one farthest from the line through them (of several the
// smallest): never removed, so that the set keeps a triangle.
std::array<Index, 3> choose_seed(const Mesh& mesh) {
  Index least = 0, most = 0, far = 0;
  for (Index v = 1; v < mesh.vertices; ++v) {
    if (point_of(mesh, v) < point_of(mesh, least)) least = v;
    if (point_of(mesh, most) < point_of(mesh, v)) most = v;
  }
  int64_t turn = 0;
  for (Index v = 0; v < mesh.vertices; ++v) {
    const int64_t t = orient2d(point_of(mesh, least), point_of(mesh, most), point_of(mesh, v));
    const int64_t farther = std::abs(t) - std::abs(turn);
    if (farther < 0 || (farther == 0 && !(point_of(mesh, v) < point_of(mesh, far)))) continue;
    far = v;
    turn = t;
  }
  if (turn > 0) return {least, most, far};
  return {least, far, most};
}

// The vertex farthest from the seed's longest side on its other side, or a vertex of the seed. It
// goes last: of a rectangle the seed has only three corners, and without the fourth, points on two
// borders would lie outside the hull, where places are dear.
Index opposite_corner(const Mesh& mesh, const std::array<Index, 3>& seed) {
  const Point least = point_of(mesh, seed[0]);
  const bool to_left = point_of(mesh, seed[1]) < point_of(mesh, seed[2]);
  const Point most = point_of(mesh, seed[to_left ? 2 : 1]);
  Index far = seed[0];
  int64_t best = 0;
  for (Index v = 0; v < mesh.vertices; ++v) {
    const int64_t d = orient2d(least, most, point_of(mesh, v)) * (to_left ? 1 : -1);
    if (d > best) {
      far = v;
      best = d;
    }
  }
  return far;
}

constexpr Index kFewVerticesLeft = 48;

// In a large terrain one of 1024 vertices stays for a phase of its own, to be a first
// picture early: each costs some 4 bits.
constexpr Index kPictureShare = 1024;

// Every how many vertices of `left` one stays in addition to those of high degree; 0: none. Only
// where the phase before left one in 64 of `all` or less: even if all stay, these two phases and
// the others, each at most 2/3 of the one before, have less than all * (1 + 5 / 64) vertices at
// their ends together (proofs.md, "Work").
Index spread_to_keep(Index vertices, Index all, Index left) {
  const Index picture = vertices / kPictureShare;
  if (picture < kSectionVertices || left > all / 64 || left < 2 * picture) return 0;
  return left / picture;
}

}  // namespace

Order breadth_first_order(Triangulation& triangulation, uint32_t degree) {
  Order order;
  order.seed = choose_seed(triangulation.mesh());
  const auto in_seed = [&](Index v) {
    return std::find(order.seed.begin(), order.seed.end(), v) != order.seed.end();
  };
  const Index last = opposite_corner(triangulation.mesh(), order.seed);
  Walk walk(triangulation);
  const Index all = triangulation.mesh().vertices;
  Index before = all, left = all;
  while (left > 3) {
    const Index spread = spread_to_keep(all, before, left);
    before = left;
    const std::vector<Index>& vertices = walk.breadth_first(order.seed[0]);
    std::vector<Index> batch;
    batch.reserve(vertices.size());
    for (std::size_t i = vertices.size(); i-- != 0;) {
      if (i >= 2 * kAhead) {
        triangulation.expect(vertices[i - kAhead], vertices[i - 2 * kAhead]);
      }
      const Index v = vertices[i];
      if (v == last && left > kFewVerticesLeft) continue;
      if (spread != 0 && i % spread == 0) continue;
      if (!in_seed(v) && triangulation.remove(v, degree)) batch.push_back(v);
    }
    if (batch.empty()) continue;  // all that may go were kept, and are not again
    left -= static_cast<Index>(batch.size());
    std::reverse(batch.begin(), batch.end());
    order.batches.push_back(std::move(batch));
  }
  std::reverse(order.batches.begin(), order.batches.end());
  return order;
}

}  // namespace microtin::stream
