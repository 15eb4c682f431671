// SPDX-License-Identifier: MIT
// A Delaunay triangulation of places of a whole pack, beyond 16 bits.
#ifndef MICROTIN_ENCODER_PACK_GLOBAL_TRIANGULATION_HPP
#define MICROTIN_ENCODER_PACK_GLOBAL_TRIANGULATION_HPP

#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/pack/borders.hpp"

namespace microtin::pack {

// Built once, to be looked at. Exact; where several points lie on an empty circle, the places alone
// decide which diagonals there are. About 80 bytes a point, O(n log n).
class GlobalTriangulation {
 public:
  // Vertex i is points[i]; coordinates below 2^31, no place twice. Throws Error if all points lie
  // on one line.
  explicit GlobalTriangulation(std::vector<GlobalPost> points);

  // Calls visit(a, b) once for every edge between two vertices.
  template <class Visit>
  void visit_edges(const Visit& visit) const {
    for (uint32_t h = 0; h < origin_.size(); ++h) {
      const uint32_t a = origin_[h], b = origin_[next(h)];
      if (h < twin_[h] && a != infinity() && b != infinity()) visit(a, b);
    }
  }

 private:
  static uint32_t next(uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static uint32_t previous(uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }
  uint32_t infinity() const { return static_cast<uint32_t>(points_.size()); }

  void start(uint32_t a, uint32_t b, uint32_t c);
  void add_triangle(uint32_t a, uint32_t b, uint32_t c);
  void pair(uint32_t g, uint32_t h);
  uint32_t infinite_edge(uint32_t triangle) const;
  uint32_t locate(GlobalPost p, uint32_t triangle) const;
  bool conflicts(uint32_t triangle, GlobalPost p) const;
  void find_cavity(uint32_t v, uint32_t triangle);
  void fill_cavity(uint32_t v);

  std::vector<GlobalPost> points_;
  std::vector<uint32_t> origin_, twin_;  // of half-edges, three for each triangle

  // For the insertion in hand.
  std::vector<uint32_t> seen_by_;      // by triangle: the last vertex that it was in conflict with
  std::vector<uint32_t> cavity_;       // triangles
  std::vector<uint32_t> starting_at_;  // by vertex: the new half-edge along the border
  struct Side {
    uint32_t from, to, outside;
  };
  std::vector<Side> sides_;
};

}  // namespace microtin::pack

#endif
