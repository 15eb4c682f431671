// SPDX-License-Identifier: MIT
// Queries on compact terrains.
#include "decoder/ring.hpp"
#include "decoder/walk.hpp"
#include "shared/digest.hpp"

namespace microtin {
namespace {

// Hints: vertices looked at along the whole path, and the distance along it where that ends.
constexpr uint32_t kSamples = 16;
constexpr uint32_t kFinest = 4;

// The middle of the triangle below the edge (a, c), looked for from both ends: one that lies below
// an edge (a, high), and the most of all below, c - 1, up to what has its least corner at a. A look
// at each in turn, so that all are at most twice as many as there are triangles below the smaller
// child.
MICROTIN_ONE_COPY uint32_t far_below(const Ring& r, uint32_t least, uint32_t a, uint32_t c,
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
uint32_t below(const Ring& r, uint32_t a, uint32_t c, uint32_t side) {
  if (a + 2 == c || look(r, a + 1, side) == c) return a + 1;
  if (look(r, c - 1, side) == a) return c - 1;
  return full_below(r, a, c, side);
}

// ... above: a if that has a right child there, else c.
uint32_t above(const Ring& r, uint32_t a, uint32_t c, uint32_t side) {
  uint32_t seen = look(r, a, side);
  if (seen == c) return a - 1;
  if (seen == r.positions + c) return low_of_full(r, a, side);
  seen = look(r, c, side);
  return seen < r.positions ? c + 1 : seen - r.positions;
}

// ... on a side of the ring's edge (a, c): c unless that has a left child, else a.
uint32_t beside(const Ring& r, uint32_t a, uint32_t c, uint32_t side) {
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
MICROTIN_ONE_COPY uint32_t beyond(const Ring& r, uint32_t u, uint32_t w, uint32_t side) {
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
    return side() != 0 || !(is_same(from_, to_) ||
                            (!is_ghost() && (is_same(apex(), from_) || is_same(apex(), to_))));
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
  bool is_same(uint32_t i, uint32_t k) const {
    return ring_.node[i].place == ring_.node[k].place &&
           (ring_.y == nullptr || ring_.y[i] == ring_.y[k]);
  }
  // From the triangle beyond the half-edge to this.
  void enter() { apex_side_ = beyond(ring_, to_, from_, side()); }

  const Ring& ring_;
  uint32_t from_, to_;
  uint32_t apex_side_;  // 2 * apex + side
};

// Triangles are numbered by middle and side.
constexpr uint32_t kFirstNumber = 2;

uint32_t number_of(const RingCursor& cursor) {
  return 2 * cursor.middle() + cursor.side() - kFirstNumber;
}

RingCursor cursor_at(const Ring& r, uint32_t number) {
  return RingCursor(r, (number + kFirstNumber) >> 1, number & 1u);
}

uint32_t triangle_count(const Ring& r) {
  return 2 * r.positions - 4;
}

// In a triangle that is no ghost: that with a number, or one near it.
RingCursor start_at(const Ring& r, uint32_t number) {
  if (number >= triangle_count(r)) number = 0;
  RingCursor cursor = cursor_at(r, number);
  if (!cursor.may_stop()) cursor.to_right();
  if (cursor.is_ghost()) cursor.cross();
  return cursor;
}

// The position of a vertex, past repeats; and back.
uint32_t position_of(const Ring& r, uint32_t v) {
  uint32_t position = v + 1;
  for (uint32_t i = 0; i < r.repeats && r.repeat[i] <= position; ++i) ++position;
  return position;
}

uint32_t vertex_of(const Ring& r, uint32_t position) {
  if (position == 0) return static_cast<uint32_t>(MICROTIN_INFINITY);
  uint32_t before = r.repeats;
  // A repeat's slit has its last position and the one before for corners.
  while (before != 0 && r.repeat[before - 1] >= position) {
    --before;
    if (r.repeat[before] != position) continue;
    position = low_of(r, position - 1, 0);
  }
  return position - 1 - before;
}

Vertex on_lattice(const microtin_compact* c, Vertex v) {
  return Vertex{static_cast<uint16_t>(v.x + c->west), static_cast<uint16_t>(v.y + c->south), v.z};
}

uint32_t distance(Point at, int32_t x, int32_t y) {
  const int32_t dx = x - at.x, dy = y - at.y;
  return static_cast<uint32_t>((dx < 0 ? -dx : dx) + (dy < 0 ? -dy : dy));
}

}  // namespace
}  // namespace microtin

using namespace microtin;

size_t microtin_compact_size(const microtin_compact* compact) {
  return sizeof(microtin_compact) + body_bytes(*compact);
}

uint32_t microtin_compact_vertex_count(const microtin_compact* compact) {
  return compact->vertices;
}

void microtin_compact_vertex(const microtin_compact* compact, uint32_t v, uint16_t* x, uint16_t* y,
                             int16_t* z) {
  const Ring r = ring_of(compact);
  const uint32_t i = position_of(r, v);
  const Point at = place_of(r, i);
  const Vertex vertex = on_lattice(compact, Vertex{at.x, at.y, r.node[i].z});
  *x = vertex.x;
  *y = vertex.y;
  *z = vertex.z;
}

uint32_t microtin_compact_triangle_count(const microtin_compact* compact) {
  return triangle_count(ring_of(compact));
}

microtin_triangle_kind microtin_compact_triangle(const microtin_compact* compact, uint32_t t,
                                                 uint32_t v[3]) {
  const Ring r = ring_of(compact);
  const RingCursor cursor = cursor_at(r, t);
  v[0] = vertex_of(r, cursor.start());
  v[1] = vertex_of(r, cursor.end());
  v[2] = vertex_of(r, cursor.apex());
  if (v[0] == v[1] || v[0] == v[2] || v[1] == v[2]) return MICROTIN_NO_AREA;
  if (cursor.is_ghost()) return MICROTIN_GHOST;
  return cursor.has_terrain() ? MICROTIN_REAL : MICROTIN_VOID;
}

uint64_t microtin_compact_digest(const microtin_compact* compact) {
  const Ring r = ring_of(compact);
  uint64_t sum = 0;
  for (uint32_t t = 0; t < triangle_count(r); ++t) {
    const RingCursor cursor = cursor_at(r, t);
    if (cursor.is_ghost() || !cursor.may_stop()) continue;
    Vertex corner[3];
    for (uint32_t i = 0; i < 3; ++i) {
      corner[i] = on_lattice(compact, cursor.vertex(cursor.corner(i)));
    }
    sum += triangle_digest(corner, !cursor.has_terrain());
  }
  return sum;
}

void microtin_compact_placement(const microtin_compact* compact, microtin_axis* x, microtin_axis* y,
                                microtin_axis* z) {
  *x = compact->axis[0];
  *y = compact->axis[1];
  *z = compact->axis[2];
}

microtin_answer microtin_compact_height_at(const microtin_compact* compact, int32_t x, int32_t y,
                                           uint32_t step_limit, uint32_t* hint, int32_t* height) {
  const int32_t most = static_cast<int32_t>(kLatticeMax) * 256;
  if (x < 0 || x > most || y < 0 || y > most) return MICROTIN_OUTSIDE;
  const Ring r = ring_of(compact);
  const FinePoint corner = fine(Point{compact->west, compact->south});
  const FinePoint p = {x - corner.x, y - corner.y};
  RingCursor cursor = start_at(r, *hint);
  const bool arrived = walk(cursor, p, step_limit == 0 ? triangle_count(r) : step_limit);
  *hint = number_of(cursor);
  if (!arrived) return MICROTIN_NOT_YET;
  return cursor.is_ghost() ? MICROTIN_OUTSIDE : answer_at(cursor, p, height);
}

uint32_t microtin_compact_hint(const microtin_compact* compact, int32_t x, int32_t y) {
  const Ring r = ring_of(compact);
  const int32_t px = (x >> 8) - compact->west, py = (y >> 8) - compact->south;
  const uint32_t end = r.positions - 1;
  uint32_t stride = end / kSamples + 1, step = stride, i = stride / 2 + 1, last = end;
  uint32_t best = 1, least = 0xFFFFFFFFu;
  for (;;) {
    for (; i < last; i += step) {
      const uint32_t far = distance(place_of(r, i), px, py);
      if (far < least) {
        least = far;
        best = i;
      }
    }
    // Half as far, to both sides of the nearest.
    stride /= 2;
    if (stride < kFinest) return 2 * best - kFirstNumber;
    i = best > stride ? best - stride : 1;
    last = best + stride < end ? best + stride + 1 : end;
    step = 2 * stride;
  }
}
