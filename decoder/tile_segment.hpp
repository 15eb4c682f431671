// SPDX-License-Identifier: MIT
// A segment in a tile: its greatest height there, and whether all of it is known. The same for each
// form of a terrain, which has
//   Cursor       as walk.hpp says
//   triangles(), at(t)   the numbers of triangles; in a ghost the cursor's apex is infinity
//   places(t, places)    those of a triangle's corners; false if it is a ghost
//   corner()     the place from which its places are seen
//   height_at(place, step_limit, hint, height)
#ifndef MICROTIN_DECODER_TILE_SEGMENT_HPP
#define MICROTIN_DECODER_TILE_SEGMENT_HPP

#include "decoder/local_point.hpp"
#include "decoder/walk.hpp"
#include "microtin/segment.h"
#include "shared/pack_format.hpp"

namespace microtin {

inline int64_t magnitude(int64_t v) {
  return v < 0 ? -v : v;
}

// rise * part / whole with 16 fractional bits, rounded to nearest, halves up; 0 <= part <= whole <
// 2^52, |rise| < 2^16. Long division, a bit of |rise| and then a fractional bit at a time: the rest
// stays below 3 * whole.
inline int64_t share(int32_t rise, int64_t part, int64_t whole) {
  const uint32_t size = static_cast<uint32_t>(rise < 0 ? -rise : rise);
  int64_t quotient = 0, rest = 0;  // quotient < 2^34
  for (int bit = 15; bit >= -17; --bit) {
    quotient *= 2;
    rest *= 2;
    if (bit >= 0 && (size >> bit & 1u) != 0) rest += part;
    for (int i = 0; i < 2 && rest >= whole; ++i) {
      rest -= whole;
      ++quotient;
    }
  }
  // One fractional bit more than is kept, and whether there is a rest.
  return rise >= 0 ? (quotient + 1) >> 1 : -((quotient + (rest != 0 ? 1 : 0)) >> 1);
}

// A part of the segment's length, from where it begins: 0 <= part <= whole <= 2^24.
struct Fraction {
  int32_t part, whole;
};

inline bool is_less(Fraction a, Fraction b) {
  return static_cast<int64_t>(a.part) * b.whole < static_cast<int64_t>(b.part) * a.whole;
}

// Whether what is `from` where the segment begins and `to` where it ends, each within +-2^51, and
// linear between, is above 0 at a fraction of it. In two parts, of which the low one is positive:
// below 2^50 and 2^51.
inline bool is_positive_at(Fraction f, int64_t from, int64_t to) {
  const int64_t low = (static_cast<int64_t>(1) << 26) - 1;
  const int64_t rest = (from & low) * (f.whole - f.part) + (to & low) * f.part;
  const int64_t high = (from >> 26) * (f.whole - f.part) + (to >> 26) * f.part + (rest >> 26);
  return high > 0 || (high == 0 && (rest & low) != 0);
}

// A segment in a tile that it touches.
//
// A part of the segment without a height is longer than a point inside a triangle, inside an edge,
// or outside the hull. A single point without a height ends such a part, or is the whole segment.
class TileSegment {
 public:
  TileSegment(const TileBox& box, const microtin_segment& segment)
      : begin_(local(box, segment.x, segment.y)),
        end_(local(box, segment.x_end, segment.y_end)),
        x_{0, 0},
        y_{0, 0},
        enters_{0, 1},
        leaves_{begin_.x != end_.x || begin_.y != end_.y, 1} {
    clip(begin_.x, end_.x, static_cast<int32_t>(box.x_end - box.x) * 256);
    clip(begin_.y, end_.y, static_cast<int32_t>(box.y_end - box.y) * 256);
  }

  // Whether the tile holds more of the segment than a point.
  bool has_length() const { return is_less(enters_, leaves_); }

  // Looks at all triangles of its terrain. False if a part of the segment in the tile is not known.
  template <class Form>
  bool look(const Form& form, int32_t* highest) {
    move(form.corner());
    bool is_known = true;
    for (uint32_t t = 0; t < form.triangles(); ++t) {
      if (!look(form, t, highest)) is_known = false;
    }
    return is_known;
  }

  // To be seen from a place of the tile, before single triangles are looked at.
  void move(Point corner) {
    const FinePoint by = fine(corner);
    begin_ = LocalPoint{begin_.x - by.x, begin_.y - by.y};
    end_ = LocalPoint{end_.x - by.x, end_.y - by.y};
    x_ = reach(begin_.x, end_.x);
    y_ = reach(begin_.y, end_.y);
  }

  template <class Form>
  MICROTIN_IN_PLACE bool look(const Form& form, uint32_t t, int32_t* highest) const {
    Point place[3];
    const bool is_aside = form.places(t, place) && are_aside(place);
    return is_aside || look_at(form.at(t), highest);
  }

 private:
  struct Corner {
    LocalPoint at;
    int32_t z;
    int64_t side;  // of the segment: positive to the left
  };

  template <class Cursor>
  MICROTIN_ONE_COPY Corner corner_of(const Cursor& cursor, uint32_t i) const {
    const Vertex v = cursor.vertex(cursor.corner(i));
    const LocalPoint at = fine_point(Point{v.x, v.y});
    return Corner{at, v.z, orient(begin_, end_, at)};
  }

  // Whole steps that the segment reaches along an axis.
  struct Reach {
    int32_t low, high;
  };

  static Reach reach(int32_t begin, int32_t end) {
    return begin < end ? Reach{begin >> 8, (end + 255) >> 8} : Reach{end >> 8, (begin + 255) >> 8};
  }

  template <class Cursor>
  bool look_at(const Cursor& cursor, int32_t* highest) const {
    if (!cursor.may_stop()) return true;
    if (cursor.is_ghost())
      return !leaves_at(cursor.place(cursor.start()), cursor.place(cursor.end()));
    const Corner corner[3] = {corner_of(cursor, 0), corner_of(cursor, 1), corner_of(cursor, 2)};
    if (!cursor.has_terrain()) {
      for (const Corner& c : corner) look_at_corner(c, highest);
      return !loses_in(cursor, corner);
    }
    for (int i = 0; i < 3; ++i) look_at_edge(corner[i], corner[i == 2 ? 0 : i + 1], highest);
    return true;
  }

  // Cuts off what lies before or behind the tile along an axis. As the segment touches the tile, it
  // enters before its end and leaves behind its beginning.
  void clip(int32_t begin, int32_t end, int32_t size) {
    if (begin == end) return;
    const bool rises = begin < end;
    const int32_t length = rises ? end - begin : begin - end;
    const Fraction enters = {rises ? -begin : begin - size, length},
                   leaves = {rises ? size - begin : begin, length};
    if (is_less(enters_, enters)) enters_ = enters;
    if (is_less(leaves, leaves_)) leaves_ = leaves;
  }

  // Whether a real triangle lies outside the bounding box of the segment, as most do.
  bool are_aside(const Point* p) const {
    return are_aside(p[0].x, p[1].x, p[2].x, x_) || are_aside(p[0].y, p[1].y, p[2].y, y_);
  }
  static bool are_aside(int32_t a, int32_t b, int32_t c, const Reach& reach) {
    return (a < reach.low && b < reach.low && c < reach.low) ||
           (a > reach.high && b > reach.high && c > reach.high);
  }

  // Whether the segment has a point on the closed edge, given its ends' sides.
  bool meets(const Corner& a, const Corner& b) const {
    if ((a.side > 0 && b.side > 0) || (a.side < 0 && b.side < 0)) return false;
    const int64_t from = orient(a.at, b.at, begin_), to = orient(a.at, b.at, end_);
    return (from <= 0 && to >= 0) || (from >= 0 && to <= 0);
  }

  // Where the segment crosses the edge; where it runs along it, ends of the edge on the segment.
  // (The segment's own ends are looked at elsewhere.)
  void look_at_edge(const Corner& a, const Corner& b, int32_t* highest) const {
    const int64_t part = magnitude(a.side), whole = part + magnitude(b.side);
    if (whole == 0) {
      look_at_corner(a, highest);
      look_at_corner(b, highest);
    } else if (meets(a, b)) {
      // The share may not fit in 32 bits; the sum lies between the ends.
      const int64_t height = static_cast<int64_t>(a.z) * 65536 + share(b.z - a.z, part, whole);
      raise(static_cast<int32_t>(height), highest);
    }
  }

  // A vertex on the segment.
  void look_at_corner(const Corner& a, int32_t* highest) const {
    if (a.side == 0 && spans(a.at)) raise(a.z * 65536, highest);
  }

  static void raise(int32_t height, int32_t* highest) {
    if (height > *highest) *highest = height;
  }

  // Whether a point on the segment's line lies between its ends.
  bool spans(LocalPoint p) const {
    return between(begin_.x, p.x, end_.x) && between(begin_.y, p.y, end_.y);
  }
  static bool between(int32_t a, int32_t p, int32_t b) {
    return (a <= p && p <= b) || (b <= p && p <= a);
  }

  // Whether a part of the segment lies in a void triangle, or on an edge of it that has no terrain
  // on the other side either.
  template <class Cursor>
  bool loses_in(Cursor cursor, const Corner* corner) const {
    if (passes_inside(corner)) return true;
    for (uint32_t i = 0; i < 3; ++i, cursor.turn()) {
      const Corner &a = corner[i], &b = corner[i == 2 ? 0 : i + 1];
      if (a.side != 0 || b.side != 0 || !runs_along(a.at, b.at)) continue;
      Cursor other = cursor;
      other.cross();
      if (!other.has_terrain()) return true;
    }
    return false;
  }

  // Whether the segment has a point inside the open triangle: no side of it, and not the segment's
  // own line, parts them (separating axes of a triangle and a segment).
  bool passes_inside(const Corner* corner) const {
    bool some_left = false, some_right = false;
    for (int i = 0; i < 3; ++i) {
      const Corner &a = corner[i], &b = corner[i == 2 ? 0 : i + 1];
      if (orient(a.at, b.at, begin_) <= 0 && orient(a.at, b.at, end_) <= 0) return false;
      some_left = some_left || a.side > 0;
      some_right = some_right || a.side < 0;
    }
    return some_left && some_right;
  }

  // Whether the segment shares more than a point with an edge on its line.
  bool runs_along(LocalPoint a, LocalPoint b) const {
    return begin_.x != end_.x ? overlap(a.x, b.x, begin_.x, end_.x)
                              : overlap(a.y, b.y, begin_.y, end_.y);
  }
  static bool overlap(int32_t a, int32_t b, int32_t c, int32_t d) {
    return larger(smaller(a, b), smaller(c, d)) < smaller(larger(a, b), larger(c, d));
  }

  // Whether, in the tile, a part of the segment lies beyond a hull edge, which runs with the
  // outside to its left.
  bool leaves_at(Point start, Point stop) const {
    const LocalPoint a = fine_point(start), b = fine_point(stop);
    const int64_t from = orient(a, b, begin_), to = orient(a, b, end_);
    if (from <= 0 && to <= 0) return false;
    return is_positive_at(enters_, from, to) || is_positive_at(leaves_, from, to);
  }

  LocalPoint begin_, end_;
  Reach x_, y_;               // as soon as it is looked at
  Fraction enters_, leaves_;  // what of the segment lies in the tile
};

}  // namespace microtin

#endif
