// SPDX-License-Identifier: MIT
// From triangle to triangle of a laced ring.
#ifndef MICROTIN_DECODER_RING_CURSOR_HPP
#define MICROTIN_DECODER_RING_CURSOR_HPP

#include "decoder/ring.hpp"

namespace microtin {

// The middle of the triangle below the edge (a, c), looked for from both ends: one that lies below
// an edge (a, high), and the most of all below, c - 1, up to what has its least corner at a. A look
// at each in turn, so that all are at most twice as many as there are triangles below the smaller
// child.
MICROTIN_ONE_COPY inline uint32_t far_below(const Ring& r, uint32_t least, uint32_t a, uint32_t c,
                                            uint32_t side) {
  const uint32_t n = r.positions;
  uint32_t most = c - 1, at = most, high = high_of(r, least, side);
  for (; high != c; high = high_of(r, least, side)) {
    least = high;
    const uint32_t seen = look(r, at, side);
    const bool is_leaf = seen >= 2 * n;
    if (!is_leaf && (at != most || seen >= n)) {
      ++at;  // the low of a full triangle: see low_of_full
      continue;
    }
    uint32_t low = most - 1;
    if (at != most) low = seen - 2 * n;
    if (!is_leaf && seen < most) low = seen;
    if (low == a) return most;
    most = at = low;
  }
  return least;
}

// ... if that is full: a + 1 is the least of all below, and what it belongs to comes to lie below
// ever wider edges (a, high). Mostly it is near.
MICROTIN_IN_PLACE inline uint32_t full_below(const Ring& r, uint32_t a, uint32_t c, uint32_t side) {
  uint32_t least = a + 1;
  for (uint32_t looks = 0; looks < 5; ++looks) {
    const uint32_t high = high_of(r, least, side);
    if (high == c) return least;
    least = high;
  }
  return far_below(r, least, a, c, side);
}

// The third corner below the edge (a, c) inside a side: the middle.
inline uint32_t below(const Ring& r, uint32_t a, uint32_t c, uint32_t side) {
  if (a + 2 == c || look(r, a + 1, side) == c) return a + 1;
  if (look(r, c - 1, side) == a) return c - 1;
  return full_below(r, a, c, side);
}

// ... above: a if that has a right child there, else c.
inline uint32_t above(const Ring& r, uint32_t a, uint32_t c, uint32_t side) {
  uint32_t seen = look(r, a, side);
  if (seen == c) return a - 1;
  if (seen == r.positions + c) return low_of_full(r, a, side);
  seen = look(r, c, side);
  return seen < r.positions ? c + 1 : seen - r.positions;
}

// ... on a side of the ring's edge (a, c): c unless that has a left child, else a.
inline uint32_t beside(const Ring& r, uint32_t a, uint32_t c, uint32_t side) {
  const uint32_t n = r.positions;
  uint32_t seen = look(r, c, side);
  if (seen >= 2 * n) return c + 1;
  if (seen > c && seen < n) return seen;
  seen = look(r, a, side);
  return seen < n ? seen : a - 1;
}

// Twice the third corner of the triangle beyond the edge from u to w of one on `side`, plus its
// side. Counter-clockwise, to the left of the path all edges but that opposite to the middle go
// upwards; to the right, downwards.
MICROTIN_ONE_COPY inline uint32_t beyond(const Ring& r, uint32_t u, uint32_t w, uint32_t side) {
  const bool rises = u < w, is_above = rises == (side != 0);
  const uint32_t a = rises ? u : w, c = rises ? w : u;
  if (is_above) return 2 * above(r, a, c, side) + side;
  if (a + 1 != c) return 2 * below(r, a, c, side) + side;
  side ^= 1u;
  return 2 * beside(r, a, c, side) + side;
}

// A half-edge of the ring, from -> to.
class RingCursor {
 public:
  // On a half-edge of the triangle with a middle: its apex is a, so 0 in a ghost.
  RingCursor(const Ring& ring, uint32_t middle, uint32_t side) : ring_(ring) { set(middle, side); }

  uint32_t start() const { return from_; }
  uint32_t end() const { return to_; }
  uint32_t apex() const { return apex_side_ >> 1; }
  uint32_t side() const { return apex_side_ & 1u; }
  bool is_ghost() const { return apex_side_ < 2; }
  bool may_stop() const { return ring_.repeats == 0 || has_area(); }
  bool has_terrain() const { return !is_ghost() && ring_.node[middle()].look[side()] < kRingFlag; }

  // On through triangles without area.
  void cross() {
    swap_ends();
    enter();
    while (!may_stop()) {
      if (is_same(apex(), from_)) {
        cross_next();
      } else {
        cross_last();
      }
    }
  }
  void cross_next() {
    from_ = apex();
    enter();
  }
  void cross_last() {
    to_ = apex();
    enter();
  }
  void cross_around(bool forward) {
    (forward ? from_ : to_) = 0;
    enter_beside_infinity();
    while (!may_stop()) {
      (forward ? to_ : from_) = apex();
      enter_beside_infinity();
    }
  }
  void turn() {
    const uint32_t third = apex();
    apex_side_ = 2 * from_ + side();
    from_ = to_;
    to_ = third;
  }

  // To the triangle of the same middle to the right of the path, where all have area.
  void to_right() { set(middle(), 1); }

  // False for those that fill the gap at a repeat: two corners are the same vertex.
  bool has_area() const {
    return side() != 0 || !(is_same(from_, to_) || is_same(apex(), from_) || is_same(apex(), to_));
  }

  uint32_t middle() const {
    const uint32_t low = from_ < to_ ? from_ : to_, high = from_ < to_ ? to_ : from_;
    return apex() < low ? low : apex() > high ? high : apex();
  }

  Point place(uint32_t i) const { return place_of(ring_, i); }
  Vertex vertex(uint32_t i) const {
    const Point p = place_of(ring_, i);
    return Vertex{p.x, p.y, ring_.node[i].z};
  }
  MICROTIN_IN_PLACE uint32_t corner(uint32_t i) const {
    return i == 0 ? from_ : i == 1 ? to_ : apex();
  }

 private:
  void set(uint32_t middle, uint32_t side) {
    from_ = middle;
    to_ = high_of(ring_, middle, side);
    apex_side_ = 2 * low_of(ring_, middle, side) + side;
    if (side != 0) swap_ends();
  }
  void swap_ends() {
    const uint32_t other = from_;
    from_ = to_;
    to_ = other;
  }
  // Infinity is nothing else, wherever its node is.
  bool is_same(uint32_t i, uint32_t k) const {
    return i != 0 && k != 0 && ring_.node[i].place == ring_.node[k].place &&
           (ring_.y == nullptr || ring_.y[i] == ring_.y[k]);
  }
  // From the triangle beyond the half-edge to this.
  void enter() { apex_side_ = beyond(ring_, to_, from_, side()); }
  // ... if one of its ends is infinity. The path is closed: from the last position it goes to 0.
  void enter_beside_infinity() {
    const uint32_t last = ring_.positions - 1, other = side() ^ 1u;
    if (from_ + to_ != last) {
      enter();
    } else {  // below that edge
      apex_side_ = beyond(ring_, last * other, last * (other ^ 1u), other);
    }
  }

  const Ring& ring_;
  uint32_t from_, to_;
  uint32_t apex_side_;  // 2 * apex + side
};

// Triangles are numbered by middle and side.
constexpr uint32_t kFirstNumber = 2;

inline uint32_t number_of(const RingCursor& cursor) {
  return 2 * cursor.middle() + cursor.side() - kFirstNumber;
}

inline uint32_t middle_of(uint32_t number) {
  return (number + kFirstNumber) >> 1;
}

inline RingCursor cursor_at(const Ring& r, uint32_t number) {
  return RingCursor(r, middle_of(number), number & 1u);
}

inline uint32_t triangle_count(const Ring& r) {
  return 2 * r.positions - 4;
}

}  // namespace microtin

#endif
