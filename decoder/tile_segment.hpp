// SPDX-License-Identifier: MIT
// The part of a segment that lies in the box of a tile.
#ifndef MICROTIN_DECODER_TILE_SEGMENT_HPP
#define MICROTIN_DECODER_TILE_SEGMENT_HPP

#include "decoder/crossing.hpp"
#include "microtin/segment.h"
#include "shared/fixed_math.hpp"
#include "shared/pack_format.hpp"

namespace microtin {

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
MICROTIN_ONE_COPY inline bool is_positive_at(Fraction f, int64_t from, int64_t to) {
  const int64_t low = (static_cast<int64_t>(1) << 26) - 1;
  const int64_t rest = (from & low) * (f.whole - f.part) + (to & low) * f.part;
  const int64_t high = (from >> 26) * (f.whole - f.part) + (to >> 26) * f.part + (rest >> 26);
  return high > 0 || (high == 0 && (rest & low) != 0);
}

// A segment in a tile that it touches.
class TileSegment {
 public:
  TileSegment(const TileBox& box, const microtin_segment& segment)
      : begin_(local(box, segment.x, segment.y)),
        end_(local(box, segment.x_end, segment.y_end)),
        size_(LocalPoint{static_cast<int32_t>(box.x_end - box.x) * 256,
                         static_cast<int32_t>(box.y_end - box.y) * 256}),
        enters_{0, 1},
        leaves_{begin_.x != end_.x || begin_.y != end_.y, 1} {
    clip(begin_.x, end_.x, size_.x);
    clip(begin_.y, end_.y, size_.y);
  }

  // Seen from the tile's first corner.
  const LocalPoint& begin() const { return begin_; }
  const LocalPoint& end() const { return end_; }

  // Whether the tile holds more of the segment than a point.
  bool has_length() const { return is_less(enters_, leaves_); }

  // A place of the tile near which the segment enters it; the begin, if that lies in the tile.
  LocalPoint entry() const {
    const uint64_t part = static_cast<uint64_t>(enters_.part) << 12;
    const int64_t along =
        enters_.part == 0
            ? 0
            : static_cast<int64_t>(divide(part, static_cast<uint64_t>(enters_.whole)).whole);
    return LocalPoint{entry(begin_.x, end_.x, size_.x, along),
                      entry(begin_.y, end_.y, size_.y, along)};
  }

  // Whether the tile holds more than a point of what lies between two places of the segment.
  bool holds_between(const Along& first, const Along& last) const {
    return is_behind(leaves_, first) && is_before(enters_, last);
  }

  // Whether a place of the segment lies before or behind that where the segment enters the tile,
  // and before or behind that where it leaves.
  bool is_before_entry(const Along& along) const { return is_behind(enters_, along); }
  bool is_behind_entry(const Along& along) const { return is_before(enters_, along); }
  bool is_before_exit(const Along& along) const { return is_behind(leaves_, along); }
  bool is_behind_exit(const Along& along) const { return is_before(leaves_, along); }

  Fraction enters() const { return enters_; }
  Fraction leaves() const { return leaves_; }

  // The corner of the tile where the segment is at a fraction of it; false if it is elsewhere.
  bool corner_at(const Fraction& f, LocalPoint* corner) const {
    corner->x = side_at(f, begin_.x, end_.x, size_.x);
    corner->y = side_at(f, begin_.y, end_.y, size_.y);
    return corner->x >= 0 && corner->y >= 0;
  }

 private:
  // Whether a fraction of the segment lies behind, or before, a place.
  static bool is_behind(const Fraction& f, const Along& along) {
    return is_positive_at(f, -along.part, along.whole - along.part);
  }
  static bool is_before(const Fraction& f, const Along& along) {
    return is_positive_at(f, along.part, along.part - along.whole);
  }

  // Along an axis, the side of the tile at a fraction of the segment; -1 if none is there. Sums are
  // below 2^50.
  static int32_t side_at(const Fraction& f, int32_t begin, int32_t end, int32_t size) {
    const int64_t at =
        static_cast<int64_t>(begin) * (f.whole - f.part) + static_cast<int64_t>(end) * f.part;
    return at == 0 ? 0 : at == static_cast<int64_t>(size) * f.whole ? size : -1;
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

  // Along an axis, where a part of 2^12 is the whole.
  static int32_t entry(int32_t begin, int32_t end, int32_t size, int64_t along) {
    const int32_t at = begin + static_cast<int32_t>((end - begin) * along >> 12);
    return at < 0 ? 0 : at > size ? size : at;
  }

  LocalPoint begin_, end_, size_;
  Fraction enters_, leaves_;  // what of the segment lies in the tile
};

}  // namespace microtin

#endif
