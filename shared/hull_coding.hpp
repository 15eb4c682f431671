// Coding of new vertices outside the hull or on its boundary.
#ifndef MICROTIN_SHARED_HULL_CODING_HPP
#define MICROTIN_SHARED_HULL_CODING_HPP

#include "shared/format.hpp"
#include "shared/height_coding.hpp"

namespace microtin {

constexpr uint32_t kHullHits = 7;  // contexts: length of the edge against the expected spacing

struct HullModel {
  AdaptiveBit hit[kHullHits];
  AdaptiveBit on_edge;
  AdaptiveBit on_border;
  ExponentModel gap;
};

inline uint32_t greatest_common_divisor(uint32_t a, uint32_t b) {
  while (b != 0) {  // at most 24 turns for 16-bit numbers (Lame)
    const uint32_t rest = a % b;
    a = b;
    b = rest;
  }
  return a;
}

inline uint32_t distance_along(int32_t d) {
  return static_cast<uint32_t>(d < 0 ? -d : d);
}

// The hull edge between a and c; the outside is to the left of c -> a.
struct HullEdge {
  Point a;
  int32_t dx, dy;  // from a to c
  uint32_t parts;  // lattice places on it cut it into so many
  Point border;    // the border of the lattice that the outside of the edge faces
  bool at_border;  // the edge is part of it
};

inline HullEdge hull_edge(const Contract& contract, Point a, Point c) {
  HullEdge edge;
  edge.a = a;
  edge.dx = static_cast<int32_t>(c.x) - a.x;
  edge.dy = static_cast<int32_t>(c.y) - a.y;
  edge.parts = greatest_common_divisor(distance_along(edge.dx), distance_along(edge.dy));
  edge.border.x = edge.dy > 0 ? contract.x_max : static_cast<uint16_t>(0);
  edge.border.y = edge.dx < 0 ? contract.y_max : static_cast<uint16_t>(0);
  edge.at_border = edge.dx == 0 ? a.x == edge.border.x : edge.dy == 0 && a.y == edge.border.y;
  return edge;
}

// log2 of the spacing of the vertices of a phase, if they were spread evenly; at least 1.
inline uint32_t expected_spacing(const Contract& contract, uint32_t batch) {
  const Log2 share = log2_of(columns(contract)) + log2_of(rows(contract)) - log2_of(batch);
  return share > 0 ? static_cast<uint32_t>(share) / (2 * kLog2One) + 1u : 1u;
}

template <class Coder>
bool code_hull_hit(Coder& coder, HullModel& model, const HullEdge& edge, uint32_t spacing,
                   bool value) {
  const uint32_t dx = distance_along(edge.dx), dy = distance_along(edge.dy);
  const uint32_t length = highest_bit(dx > dy ? dx : dy) + kHullHits / 2;  // not both are 0
  const uint32_t context = length < spacing ? 0 : length - spacing;
  return code_bit(coder, model.hit[context < kHullHits ? context : kHullHits - 1], value);
}

// A distance along an edge or a border: 1 or more, about 2^spacing, usually less than `end`.
template <class Coder>
uint32_t code_gap(Coder& coder, HullModel& model, MantissaModel& mantissa, uint32_t end,
                  uint32_t spacing, uint32_t gap) {
  const uint32_t most = highest_bit(end) + 1u;
  return 1u + code_magnitude(coder, model.gap, mantissa, spacing < most ? spacing : most - 1u, most,
                             gap - 1u);
}

// One coordinate of a place outside the edge: on the border that the outside faces, if there is
// such a border, or anywhere.
template <class Coder>
bool code_on_border(Coder& coder, HullModel& model, bool faced, bool value) {
  return faced && code_bit(coder, model.on_border, value);
}

// A point beyond the edge: on it, on the border of the lattice, or anywhere. Gaps that lead too far
// give a, which is not beyond.
template <class Coder>
Point code_hull_place(Coder& coder, HullModel& model, MantissaModel& mantissa,
                      const Contract& contract, const HullEdge& edge, uint32_t spacing,
                      Point place) {
  const Point a = edge.a;
  const int32_t along_x = static_cast<int32_t>(place.x) - a.x,
                along_y = static_cast<int32_t>(place.y) - a.y;
  if (edge.at_border || (edge.parts > 1 && code_bit(coder, model.on_edge,
                                                    static_cast<int64_t>(along_x) * edge.dy ==
                                                        static_cast<int64_t>(along_y) * edge.dx))) {
    const int32_t parts = static_cast<int32_t>(edge.parts);
    const int32_t step_x = edge.dx / parts, step_y = edge.dy / parts;
    const int32_t steps = step_x != 0 ? along_x / step_x : along_y / step_y;
    const uint32_t gap =
        code_gap(coder, model, mantissa, edge.parts, spacing, static_cast<uint32_t>(steps));
    const int32_t held = gap < edge.parts ? static_cast<int32_t>(gap) : 0;
    return Point{static_cast<uint16_t>(a.x + step_x * held),
                 static_cast<uint16_t>(a.y + step_y * held)};
  }
  const bool at_x = code_on_border(coder, model, edge.dy != 0, place.x == edge.border.x);
  const bool at_y = code_on_border(coder, model, edge.dx != 0, place.y == edge.border.y);
  const uint32_t x = at_x ? edge.border.x : coder.uniform(columns(contract), place.x);
  const uint32_t y = at_y ? edge.border.y : coder.uniform(rows(contract), place.y);
  return Point{static_cast<uint16_t>(x), static_cast<uint16_t>(y)};
}

}  // namespace microtin

#endif
