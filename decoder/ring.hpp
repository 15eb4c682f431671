// SPDX-License-Identifier: MIT
// The laced ring: what a compact terrain holds, and how its triangles are found.
// shared/docs/format-compact.md explains it and proves what the comments here say.
//
// Positions 0 .. N - 1 run along a closed walk through all vertices; 0 is infinity. On each side of
// it lies a polygon cut into triangles. Each triangle a < b < c of a side has a middle b of its
// own, 1 .. N - 2. It has a child beyond (a, b) unless a + 1 = b, and one beyond (b, c) unless b +
// 1 = c; in a binary tree these are the left and the right child, and b counts in order.
#ifndef MICROTIN_DECODER_RING_HPP
#define MICROTIN_DECODER_RING_HPP

#include "decoder/state.hpp"
#include "microtin/compact.h"
#include "shared/interpolation.hpp"

namespace microtin {

// A look's highest bit: the triangle is void, or has no area. The next: it has two children, a
// *full* one, or none, a *leaf*. The rest is a number of a position.
constexpr uint32_t kRingFlag = 1ul << (MICROTIN_INDEX_BITS - 1);
constexpr uint32_t kRingPair = kRingFlag >> 1;
constexpr uint32_t kRingNumber = kRingPair - 1;

// The number of a position's look, as the middle of a triangle of a side, is
//   of one with one child   the far end: a, then c = b + 1, or c, then a = b - 1
//   of a full one           c
//   of a leaf               the a of the last full one before, 0 if there is none
// so that it tells a from c, and full ones from leaves, by being less than b or not. Full ones and
// leaves take turns along a side. The looks of positions that are no middles are 0.
//
// The looks of a side: of position i at [2 * i], since those of both sides take turns, too.
typedef const Index* RingSide;

// What is at a position.
struct RingVertex {
  uint16_t place;  // x | y << 8 from the corner of the terrain's box if that is narrow, else x
  int16_t z;
};

// Whether a look can tell this many positions apart.
constexpr bool has_room_for(uint32_t positions) {
  return positions <= kRingNumber + 1;
}

struct RingShape {
  uint32_t vertices;
  uint32_t positions;
  uint16_t west, south;  // of the box if it is narrow, else 0
  uint32_t is_narrow;    // the box is less than 256 steps wide and high
};

}  // namespace microtin

// It holds no pointers, so that it can be moved. Behind it lies its body: two looks for each
// position, the positions that repeat a vertex, in order, the vertex of each position, and y of
// each if it is not narrow.
struct microtin_compact : microtin::RingShape {
  uint32_t below, above;  // margins, see microtin_mesh
  microtin_axis axis[3];
};

static_assert(sizeof(microtin_compact) == MICROTIN_COMPACT_HEADER_BYTES,
              "see compact.h, format-pack.md");
static_assert(sizeof(microtin_compact) % alignof(microtin::Index) == 0, "looks follow it");

namespace microtin {

struct Ring {
  RingSide left;  // the right is one further
  const RingVertex* vertex;
  const uint16_t* y;  // null: narrow
  uint32_t positions;
};

inline uint32_t repeats_of(const RingShape& header) {
  return header.positions - 1 - header.vertices;
}

// Bytes that it takes with indices of this many bytes. With those at hand less than the mesh, which
// is in memory.
MICROTIN_IN_PLACE inline size_t compact_bytes(const RingShape& header, uint32_t index_bytes) {
  const uint32_t each = 2 * index_bytes + (header.is_narrow != 0 ? 4u : 6u);
  return sizeof(microtin_compact) +
         static_cast<size_t>(header.positions * each + repeats_of(header) * index_bytes);
}

inline size_t body_bytes(const RingShape& header) {
  return compact_bytes(header, sizeof(Index)) - sizeof(microtin_compact);
}

inline Ring ring_of(const microtin_compact* c) {
  const RingSide left = reinterpret_cast<RingSide>(c + 1);
  const RingVertex* const vertex =
      reinterpret_cast<const RingVertex*>(left + 2 * c->positions + repeats_of(*c));
  const uint16_t* const y = reinterpret_cast<const uint16_t*>(vertex + c->positions);
  return Ring{left, vertex, c->is_narrow != 0 ? nullptr : y, c->positions};
}

// The positions that repeat a vertex.
inline const Index* repeats_in(const microtin_compact* c) {
  return reinterpret_cast<const Index*>(c + 1) + 2 * c->positions;
}

MICROTIN_IN_PLACE inline uint32_t look(RingSide side, uint32_t middle) {
  return side[2 * middle];
}

// The number of a look.
MICROTIN_IN_PLACE inline uint32_t told(RingSide side, uint32_t middle) {
  return look(side, middle) & kRingNumber;
}

MICROTIN_IN_PLACE inline bool has_left_child(uint32_t seen, uint32_t middle) {
  return ((seen & kRingNumber) < middle) != ((seen & kRingPair) != 0);
}

// The a of a full triangle, from the next leaf.
MICROTIN_ONE_COPY inline uint32_t low_of_full(RingSide side, uint32_t middle) {
  RingSide seen = side + 2 * middle;
  do {
    seen += 2;
  } while ((*seen & kRingPair) == 0);
  return *seen & kRingNumber;
}

// The least and the greatest corner of the triangle with a middle.
struct RingSpan {
  uint32_t low, high;
};

MICROTIN_IN_PLACE inline RingSpan span_of(RingSide side, uint32_t middle) {
  const uint32_t seen = look(side, middle), number = seen & kRingNumber;
  const bool is_pair = (seen & kRingPair) != 0;
  if (number > middle) return RingSpan{is_pair ? low_of_full(side, middle) : middle - 1, number};
  return RingSpan{is_pair ? middle - 1 : number, middle + 1};
}

inline uint32_t low_of(RingSide side, uint32_t middle) {
  return span_of(side, middle).low;
}

MICROTIN_IN_PLACE inline uint32_t high_of(RingSide side, uint32_t middle) {
  const uint32_t number = told(side, middle);
  return number > middle ? number : middle + 1;
}

// Relative to the corner of the box if narrow.
MICROTIN_IN_PLACE inline Point place_of(const Ring& r, uint32_t i) {
  const uint16_t place = r.vertex[i].place;
  if (r.y != nullptr) return Point{place, r.y[i]};
  return Point{static_cast<uint16_t>(place & 255u), static_cast<uint16_t>(place >> 8)};
}

}  // namespace microtin

#endif
