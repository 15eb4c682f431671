// SPDX-License-Identifier: MIT
// The laced ring: what a compact terrain holds, and how its triangles are found. shared/COMPACT.md
// explains it and proves what the comments here say.
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

// The highest bit of a look: the triangle is void.
constexpr uint32_t kRingFlag = 1ul << (MICROTIN_INDEX_BITS - 1);
constexpr uint32_t kRingNumber = kRingFlag - 1;

// A position, as the middle of a triangle on each side. Its look says, below kRingFlag:
//   0 .. N - 1     one child: a if it is less than b, then c = b + 1; else c, then a = b - 1
//   N .. 2 N - 1   two children, a *full* triangle: N + c
//   2 N on         none, a *leaf*: 2 N + the a of the last full one before, if there is one
// Full ones and leaves take turns along a side. The looks of positions that are no middles are 0.
struct RingNode {
  Index look[2];
  uint16_t place;  // x | y << 8 from the corner of the terrain's box if that is narrow, else x
  int16_t z;
};

// Whether so many positions have room in a look. Behind the a of a full triangle come at least a
// child, b, a child and c, so that 2 N + a is at most 3 N - 5.
constexpr bool has_room_for(uint32_t positions) {
  return positions <= (kRingNumber + 5) / 3;
}

struct RingShape {
  uint32_t vertices;
  uint32_t positions;
  uint16_t west, south;  // of the box if it is narrow, else 0
  uint32_t is_narrow;    // the box is less than 256 steps wide and high
};

}  // namespace microtin

// It holds no pointers, so that it can be moved. Behind it lies its body: a node for each position,
// the positions that repeat a vertex, in order, and y of each position if it is not narrow.
struct microtin_compact : microtin::RingShape {
  microtin_axis axis[3];
};

static_assert(sizeof(microtin_compact) == MICROTIN_COMPACT_HEADER_BYTES, "see compact.h, PACK.md");
static_assert(sizeof(microtin_compact) % alignof(microtin::RingNode) == 0, "nodes follow it");

namespace microtin {

struct Ring {
  const RingNode* node;
  const uint16_t* y;  // null: narrow
  const Index* repeat;
  uint32_t positions;
  uint32_t repeats;
};

inline uint32_t repeats_of(const RingShape& header) {
  return header.positions - 1 - header.vertices;
}

// Bytes that it takes with numbers of so many bytes. With those at hand less than the mesh, which
// is in memory.
inline size_t compact_bytes(const RingShape& header, uint32_t index_bytes) {
  const uint32_t each = 2 * index_bytes + (header.is_narrow != 0 ? 4u : 6u);
  return sizeof(microtin_compact) +
         static_cast<size_t>(header.positions * each + repeats_of(header) * index_bytes);
}

inline size_t body_bytes(const RingShape& header) {
  return compact_bytes(header, sizeof(Index)) - sizeof(microtin_compact);
}

inline Ring ring_of(const microtin_compact* c) {
  const uint32_t repeats = repeats_of(*c);
  const RingNode* const node = reinterpret_cast<const RingNode*>(c + 1);
  const Index* const repeat = reinterpret_cast<const Index*>(node + c->positions);
  const uint16_t* const y = reinterpret_cast<const uint16_t*>(repeat + repeats);
  return Ring{node, c->is_narrow != 0 ? nullptr : y, repeat, c->positions, repeats};
}

MICROTIN_IN_PLACE inline uint32_t look(const Ring& r, uint32_t middle, uint32_t side) {
  return r.node[middle].look[side] & kRingNumber;
}

// The a of a full triangle, from the next leaf.
MICROTIN_ONE_COPY inline uint32_t low_of_full(const Ring& r, uint32_t middle, uint32_t side) {
  const uint32_t leaves = 2 * r.positions;
  uint32_t seen = 0;
  while (seen < leaves) seen = look(r, ++middle, side);
  return seen - leaves;
}

inline uint32_t low_of(const Ring& r, uint32_t middle, uint32_t side) {
  const uint32_t seen = look(r, middle, side), n = r.positions;
  if (seen >= n && seen < 2 * n) return low_of_full(r, middle, side);
  return seen < middle ? seen : middle - 1;
}

inline uint32_t high_of(const Ring& r, uint32_t middle, uint32_t side) {
  const uint32_t seen = look(r, middle, side), n = r.positions;
  if (seen >= n && seen < 2 * n) return seen - n;
  return seen > middle && seen < n ? seen : middle + 1;
}

// Relative to the corner of the box if narrow.
MICROTIN_IN_PLACE inline Point place_of(const Ring& r, uint32_t i) {
  const uint16_t place = r.node[i].place;
  if (r.y != nullptr) return Point{place, r.y[i]};
  return Point{static_cast<uint16_t>(place & 255u), static_cast<uint16_t>(place >> 8)};
}

}  // namespace microtin

#endif
