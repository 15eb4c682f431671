// SPDX-License-Identifier: MIT
// Terrains as segments see them (segment_walk.hpp): meshes, and laced rings with their cursor.
#ifndef MICROTIN_DECODER_TERRAIN_FORMS_HPP
#define MICROTIN_DECODER_TERRAIN_FORMS_HPP

#include "decoder/local_point.hpp"
#include "decoder/ring.hpp"
#include "decoder/walk.hpp"

namespace microtin {

class MeshForm {
 public:
  typedef microtin_mesh Terrain;
  typedef MeshCursor Cursor;
  static constexpr bool kIsCompact = false;

  explicit MeshForm(const void* space, uint32_t flags = 0)
      : m_(*static_cast<const microtin_mesh*>(space)), flags_(flags) {}

  uint32_t triangles() const { return m_.mesh.triangles; }
  Point corner() const { return Point{0, 0}; }
  MeshCursor at(uint32_t t) const {
    const Index first = first_edge(static_cast<Index>(t));
    const Index* const v = m_.mesh.origin + first;
    const uint32_t i = v[0] == kInfinity ? 1u : v[1] == kInfinity ? 2u : 0u;
    return MeshCursor(m_, static_cast<Index>(first + i));
  }
  uint32_t number(const MeshCursor& cursor) const { return cursor.triangle(); }
  uint32_t below() const { return m_.below; }
  // The nearest of some triangles: a walk from there is shorter by more than the look costs.
  MICROTIN_ONE_COPY uint32_t hint(LocalPoint p) const {
    const uint32_t stride = m_.mesh.triangles / kSamples + 1;
    uint32_t best = 0, least = UINT32_MAX;
    for (uint32_t t = 0; t < m_.mesh.triangles; t += stride) {
      const Index* const v = m_.mesh.origin + first_edge(static_cast<Index>(t));
      const Point at = m_.mesh.place[v[0] != kInfinity ? v[0] : v[1]];
      const uint32_t far = static_cast<uint32_t>(magnitude((p.x >> 8) - at.x)) +
                           static_cast<uint32_t>(magnitude((p.y >> 8) - at.y));
      if (far >= least) continue;
      least = far;
      best = t;
    }
    return best;
  }
  microtin_query_result height_at(LocalPoint p, uint32_t step_limit, uint32_t* hint,
                                  int32_t* height) const {
    return microtin_mesh_height_at(&m_, p.x, p.y, hint, height, flags_, step_limit);
  }

 private:
  static constexpr uint32_t kSamples = 16;

  static int32_t magnitude(int32_t v) { return v < 0 ? -v : v; }

  const microtin_mesh& m_;
  uint32_t flags_;
};

// The middle of the triangle below the edge (a, c), looked for from both ends: one that lies below
// an edge (a, high), and the most of all below, c - 1, up to what has its least corner at a. A look
// at each in turn, so that all are at most twice as many as there are triangles below the smaller
// child.
MICROTIN_ONE_COPY inline uint32_t far_below(RingSide side, uint32_t least, uint32_t a, uint32_t c) {
  uint32_t most = c - 1, at = most, high = high_of(side, least);
  for (; high != c; high = high_of(side, least)) {
    least = high;
    const uint32_t seen = look(side, at), number = seen & kRingNumber;
    const bool is_pair = (seen & kRingPair) != 0;
    if (at == most ? is_pair && number > most : !is_pair) {
      ++at;  // the low of a full triangle: see low_of_full
      continue;
    }
    const uint32_t low = at != most || (!is_pair && number < most) ? number : most - 1;
    if (low == a) return most;
    most = at = low;
  }
  return least;
}

// The third corner below the edge (a, c) inside a side, the middle: the first or the last there if
// that has one child, else full. Then a + 1 is the least of all below, and what it belongs to comes
// to lie below ever wider edges (a, high). Mostly it is near.
MICROTIN_IN_PLACE inline uint32_t below(RingSide side, uint32_t a, uint32_t c) {
  uint32_t least = a + 1, high = high_of(side, least);
  if (high != c && (look(side, c - 1) & ~kRingFlag) == a) return c - 1;
  for (uint32_t looks = 0; high != c; ++looks) {
    least = high;
    if (looks == 5) return far_below(side, least, a, c);
    high = high_of(side, least);
  }
  return least;
}

// A half-edge of the ring, from -> to.
class RingCursor {
 public:
  // On a half-edge of the triangle with a middle: its apex is a, so 0 in a ghost.
  RingCursor(const Ring& ring, uint32_t middle, uint32_t side) : ring_(&ring) { set(middle, side); }

  uint32_t start() const { return from_; }
  uint32_t end() const { return to_; }
  uint32_t apex() const { return apex_; }
  uint32_t side() const { return looks_ == ring_->left ? 0 : 1; }
  uint32_t middle() const { return middle_; }
  bool is_ghost() const { return apex_ == 0; }
  bool may_stop() const { return !is_flagged() || has_area(); }
  MICROTIN_IN_PLACE bool has_terrain() const { return !is_ghost() && !is_flagged(); }
  bool is_void() const { return is_flagged(); }

  // On through triangles without area.
  void cross() {
    swap_ends();
    enter();
    while (!may_stop()) {
      if (is_same(apex_, from_)) {
        leave_next();
      } else {
        leave_last();
      }
      enter();
    }
  }
  void leave_next() { from_ = apex_; }
  void leave_last() { to_ = apex_; }
  // From the triangle beyond the half-edge to this: up, if that has its middle opposite to it.
  void enter() {
    const bool falls = to_ < from_;
    const uint32_t a = falls ? to_ : from_, c = falls ? from_ : to_;
    if (a != middle_ && c != middle_) {
      const uint32_t seen = look(looks_, a);
      if ((seen & kRingNumber) == c) {
        middle_ = a;
        apex_ = (seen & kRingPair) != 0 ? low_of_full(looks_, a) : a - 1;
        return;
      }
    } else if (a + 1 == c) {
      change_sides();
      if (has_left_child(look(looks_, c), c)) {
        const uint32_t seen = look(looks_, a);
        middle_ = a;
        apex_ = (seen & kRingPair) != 0 ? a - 1 : seen & kRingNumber;
        return;
      }
    } else {
      apex_ = middle_ = below(looks_, a, c);
      return;
    }
    middle_ = c;
    apex_ = high_of(looks_, c);
  }
  void cross_around(bool forward) {
    (forward ? from_ : to_) = 0;
    enter_beside_infinity();
    while (!may_stop()) {
      (forward ? to_ : from_) = apex_;
      enter_beside_infinity();
    }
  }
  void turn() {
    const uint32_t third = apex_;
    apex_ = from_;
    from_ = to_;
    to_ = third;
  }

  // To the triangle of the same middle to the right of the path, where all have area.
  void to_right() { set(middle_, 1); }

  // False for those that fill the gap at a repeat: two corners are the same vertex.
  bool has_area() const {
    return !is_same(from_, to_) && !is_same(apex_, from_) && !is_same(apex_, to_);
  }

  Point place(uint32_t i) const { return place_of(*ring_, i); }
  MICROTIN_IN_PLACE Point apex_place() const { return place_of(*ring_, apex_); }
  Vertex vertex(uint32_t i) const {
    const Point p = place_of(*ring_, i);
    return Vertex{p.x, p.y, ring_->vertex[i].z};
  }
  MICROTIN_IN_PLACE uint32_t corner(uint32_t i) const {
    return i == 0 ? from_ : i == 1 ? to_ : apex_;
  }

 private:
  void set(uint32_t middle, uint32_t side) {
    looks_ = ring_->left + side;
    const RingSpan span = span_of(looks_, middle);
    from_ = middle_ = middle;
    to_ = span.high;
    apex_ = span.low;
    if (side != 0) swap_ends();
  }
  void swap_ends() {
    const uint32_t other = from_;
    from_ = to_;
    to_ = other;
  }
  void change_sides() { looks_ = ring_->left + (side() ^ 1u); }
  MICROTIN_IN_PLACE bool is_flagged() const { return look(looks_, middle_) >= kRingFlag; }
  // Whether two corners of a marked triangle are the same vertex. Infinity is a corner of such a
  // triangle only if the other two are the same.
  bool is_same(uint32_t i, uint32_t k) const { return place(i) == place(k); }
  // Enters as enter() does, if one end of the half-edge is infinity. The path is closed: from the
  // last position it goes to 0, and that edge is above all triangles of either side, so seen from
  // the other the way leads down.
  void enter_beside_infinity() {
    if (from_ + to_ == ring_->positions - 1) {
      change_sides();
      middle_ = 0;
    }
    enter();
  }

  const Ring* ring_;
  RingSide looks_;
  uint32_t from_, to_, apex_, middle_;
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

class RingForm {
 public:
  typedef microtin_compact Terrain;
  typedef RingCursor Cursor;
  static constexpr bool kIsCompact = true;

  explicit RingForm(const void* space)
      : c_(static_cast<const microtin_compact*>(space)), ring_(ring_of(c_)) {}

  uint32_t triangles() const { return triangle_count(ring_); }
  Point corner() const { return Point{c_->west, c_->south}; }
  RingCursor at(uint32_t t) const { return cursor_at(ring_, t); }
  uint32_t number(const RingCursor& cursor) const { return number_of(cursor); }
  uint32_t below() const { return c_->below; }
  uint32_t hint(LocalPoint p) const { return microtin_compact_hint(c_, p.x, p.y); }
  microtin_query_result height_at(LocalPoint p, uint32_t step_limit, uint32_t* hint,
                                  int32_t* height) const {
    return microtin_compact_height_at(c_, p.x, p.y, hint, height, step_limit);
  }

 private:
  const microtin_compact* c_;
  Ring ring_;
};

}  // namespace microtin

#endif
