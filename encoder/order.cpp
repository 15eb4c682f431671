#include "encoder/order.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace microtin {
namespace {

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
    const Mesh& mesh = triangulation_.mesh();
    ++walks_;
    met_[entry(kInfinity)] = walks_;
    found_ = 0;
    Index from_infinity = triangulation_.edge_of(kInfinity);
    while (mesh.origin[next_in_triangle(from_infinity)] != first) {
      from_infinity = mesh.twin[previous_in_triangle(from_infinity)];
    }
    turn_around(mesh.twin[from_infinity]);
    for (std::size_t i = 0; i < found_; ++i) turn_around(arrivals_[i]);
    vertices_.resize(found_);
    return vertices_;
  }

 private:
  static std::size_t entry(Index v) { return static_cast<Index>(v + 1u); }

  // `arrival` goes from the parent to the vertex.
  void turn_around(Index arrival) {
    const Mesh& mesh = triangulation_.mesh();
    Index into = arrival;
    do {
      const Index neighbour = mesh.origin[into];
      // Written in any case, kept if it is new: nobody can predict which it is.
      vertices_[found_] = neighbour;
      arrivals_[found_] = mesh.twin[into];
      uint8_t& met = met_[entry(neighbour)];
      found_ += met != walks_;
      met = walks_;
      into = mesh.twin[next_in_triangle(into)];
    } while (into != arrival);
  }

  const Triangulation& triangulation_;
  std::vector<uint8_t> met_;     // the last walk that met it, entry v + 1
  std::vector<Index> vertices_;  // found so far
  std::vector<Index> arrivals_;  // and the half-edges to them
  std::size_t found_ = 0;
  uint8_t walks_ = 0;  // at most 58 (FORMAT.md, "Work")
};

// The smallest point, the largest, and the one farthest from the line through them (of several the
// smallest): never removed, so that the set keeps a triangle.
std::array<Index, 3> choose_seed(const Mesh& mesh) {
  Index least = 0, most = 0, far = 0;
  for (Index v = 1; v < mesh.vertices; ++v) {
    if (point_of(mesh, v) < point_of(mesh, least)) least = v;
    if (point_of(mesh, most) < point_of(mesh, v)) most = v;
  }
  const auto distance = [&](Index v) {
    return orient2d(point_of(mesh, least), point_of(mesh, most), point_of(mesh, v));
  };
  for (Index v = 0; v < mesh.vertices; ++v) {
    const int64_t d = std::abs(distance(v)), best = std::abs(distance(far));
    if (d > best || (d == best && point_of(mesh, v) < point_of(mesh, far))) far = v;
  }
  if (distance(far) > 0) return {least, most, far};
  return {least, far, most};
}

}  // namespace

Order breadth_first_order(Triangulation& triangulation, uint32_t degree) {
  Order order;
  order.seed = choose_seed(triangulation.mesh());
  const auto in_seed = [&](Index v) {
    return std::find(order.seed.begin(), order.seed.end(), v) != order.seed.end();
  };
  Walk walk(triangulation);
  Index left = triangulation.mesh().vertices;
  while (left > 3) {
    const std::vector<Index>& vertices = walk.breadth_first(order.seed[0]);
    std::vector<Index> batch;
    for (auto v = vertices.rbegin(); v != vertices.rend(); ++v) {
      if (!in_seed(*v) && triangulation.remove(*v, degree)) batch.push_back(*v);
    }
    left -= static_cast<Index>(batch.size());
    std::reverse(batch.begin(), batch.end());
    order.batches.push_back(std::move(batch));
  }
  std::reverse(order.batches.begin(), order.batches.end());
  return order;
}

}  // namespace microtin
