// SPDX-License-Identifier: MIT
// Coding of new vertices outside the hull or on its boundary.
#ifndef MICROTIN_SHARED_HULL_CODING_HPP
#define MICROTIN_SHARED_HULL_CODING_HPP

#include "shared/format.hpp"
#include "shared/height_coding.hpp"
#include "shared/parity_coding.hpp"

namespace microtin {

// The hull edge from a to c; the outside is to its right.
struct HullEdge {
  Point a;
  Offset along;    // from a to c
  int32_t length;  // in lattice steps if the edge is part of the lattice's border, else 0
};

inline bool at_border(uint16_t a, uint16_t c, uint16_t most) {
  return a == c && (a == 0 || a == most);
}

inline HullEdge hull_edge(const Contract& contract, Point a, Point c) {
  HullEdge edge = {a, c - a, 0};
  if (at_border(a.x, c.x, contract.x_max) || at_border(a.y, c.y, contract.y_max)) {
    edge.length = static_cast<int32_t>(absolute(edge.along.x + edge.along.y));
  }
  return edge;
}

// A coordinate that is likely to be the smallest or the largest.
template <class Coder>
uint16_t code_outer_coordinate(Coder& coder, uint32_t largest, uint32_t value) {
  if (coder.bit(kProbabilityOne / 4 * 3, value == 0 || value == largest)) {
    const bool high = coder.bit(kProbabilityOne / 2, value == largest);
    return static_cast<uint16_t>(high ? largest : 0);
  }
  return static_cast<uint16_t>(coder.uniform(largest + 1u, value));
}

// How many steps beyond a the next point on an edge at the border is. Such that lead too far give
// 0. `density` is the logarithm of vertices per unit area.
template <class Coder>
int32_t code_gap(Coder& coder, ExponentModel& gap, MantissaModel& mantissa, Parities& parities,
                 const Contract& contract, const HullEdge& edge, Log2 density, FastInt known) {
  const bool along_x = edge.along.y == 0;
  const bool odd =
      along_x ? is_odd(edge.a.x, contract.odd_origin_x) : is_odd(edge.a.y, contract.odd_origin_y);
  Tally& tally = parities.first[along_x ? 0 : 1];
  const Ruling steps = rule(coder, tally, Lines{1, edge.length - 1}, odd, known);
  uint32_t bits = density < 0 ? static_cast<uint32_t>(-density) / (2 * kLog2One) : 0;  // at most 16
  if (steps.step == 2 && bits != 0) --bits;
  const FastInt first = steps.numbers.first;
  const FastInt number = first + static_cast<FastInt>(code_magnitude(
                                     coder, gap, mantissa, bits,
                                     static_cast<uint32_t>(number_of(steps, known) - first)));
  if (number - first >= steps.numbers.count) return 0;
  const FastInt gone = line_at(steps, number);
  learn(tally, is_odd(gone, odd));
  return static_cast<int32_t>(gone);
}

// A point on the edge, if that is at the border, or anywhere. Gaps that lead too far give a, which
// is not beyond the edge.
template <class Coder>
Point code_hull_place(Coder& coder, ExponentModel& gap, MantissaModel& mantissa, Parities& parities,
                      const Contract& contract, const HullEdge& edge, Log2 density) {
  const Vertex next = coder.next();
  Point place = {next.x, next.y};
  if (edge.length == 0) {
    place.x = code_outer_coordinate(coder, contract.x_max, place.x);
    place.y = code_outer_coordinate(coder, contract.y_max, place.y);
    return place;
  }
  const Offset past = place - edge.a;
  const int32_t length = edge.length;
  const int32_t steps =
      code_gap(coder, gap, mantissa, parities, contract, edge, density, absolute(past.x + past.y));
  return Point{static_cast<uint16_t>(edge.a.x + edge.along.x / length * steps),
               static_cast<uint16_t>(edge.a.y + edge.along.y / length * steps)};
}

}  // namespace microtin

#endif
