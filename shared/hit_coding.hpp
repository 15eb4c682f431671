// SPDX-License-Identifier: MIT
// Coding of whether the next vertex is in conflict with a triangle: a hit or a miss.
#ifndef MICROTIN_SHARED_HIT_CODING_HPP
#define MICROTIN_SHARED_HIT_CODING_HPP

#include "shared/free_region.hpp"
#include "shared/mesh.hpp"
#include "shared/place_coding.hpp"
#include "shared/probability.hpp"

namespace microtin {

constexpr uint32_t kHitEntries = 15;

// A curve for each context: 0 to 3 by the triangles behind that are certified, 4 and 5 where the
// corner is new to the walk, 6 at the hull.
struct HitModel {
  Curve<kHitEntries> curve[7];
};

struct HitEstimate {
  int context;
  int32_t position;  // on the context's curve
};

// The longer the edge, against the spacing of the vertices, the likelier is a hit.
inline HitEstimate estimate_hull_hit(const HullEdge& edge, Log2 density) {
  const FastInt length = absolute(edge.along.x) | absolute(edge.along.y);
  return HitEstimate{6, 2 * log2_of(static_cast<uint32_t>(length)) + density + 6 * 256};
}

// The larger the free region, the likelier.
inline HitEstimate estimate_hit(FreeRegion& region, Log2 density) {
  region.expected = free_area(region) + density;
  return HitEstimate{(region.next.certified ? 1 : 0) + (region.opposite_certified ? 2 : 0),
                     region.expected + 6 * 256};
}

// The degree of the vertex where h starts, infinity counted, but at most `most`.
inline uint32_t degree_up_to(const Mesh& mesh, Index h, uint32_t most) {
  const Index first = h;
  uint32_t degree = 0;
  do {
    ++degree;
    h = mesh.twin[previous_in_triangle(h)];
  } while (h != first && degree < most);
  return degree;
}

// A miss makes the corner c where `into` starts known to the walk if it is not yet. The encoder
// removes every vertex whose degree is at most D, `least`, when the walk comes to know it, so such
// a c must still get neighbours: a hit.
inline void estimate_newcomer(const Mesh& mesh, Index into, uint32_t least, HitEstimate& estimate) {
  const uint32_t degree = degree_up_to(mesh, into, least + 2u);
  estimate.context = degree < least + 2u ? 4 : 5;
  if (degree <= least) estimate.position = static_cast<int32_t>(kHitEntries) * 256;
}

template <class Coder>
MICROTIN_IN_PLACE inline bool code_hit(Coder& coder, HitModel& model, const HitEstimate& estimate,
                                       bool is_hit) {
  return code_on_curve(coder, model.curve[estimate.context], estimate.position, is_hit);
}

}  // namespace microtin

#endif
