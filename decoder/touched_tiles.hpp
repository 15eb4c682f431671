// SPDX-License-Identifier: MIT
// The tiles that a segment may touch, from where it begins.
#ifndef MICROTIN_DECODER_TOUCHED_TILES_HPP
#define MICROTIN_DECODER_TOUCHED_TILES_HPP

#include "decoder/local_point.hpp"
#include "microtin/segment.h"

namespace microtin {

constexpr int64_t kSegmentMost = static_cast<int64_t>(1) << 40;
constexpr int64_t kSegmentLongest = static_cast<int64_t>(1) << 24;

MICROTIN_ONE_COPY inline bool is_within(int64_t value, int64_t most) {
  return value <= most && value >= -most;
}

// Along an axis.
MICROTIN_ONE_COPY inline bool is_legal(int64_t begin, int64_t end) {
  return is_within(begin, kSegmentMost) && is_within(end, kSegmentMost) &&
         is_within(end - begin, kSegmentLongest - 1);
}

MICROTIN_ONE_COPY inline bool is_legal(const microtin_segment& c) {
  return is_legal(c.x, c.x_end) && is_legal(c.y, c.y_end);
}

// A position that no other tile has.
inline microtin_segment middle_of(const TileGrid& grid, uint32_t tile) {
  const TileBox box = tile_box(grid, tile);
  const int64_t x = (static_cast<int64_t>(box.x) + box.x_end) * 128,
                y = (static_cast<int64_t>(box.y) + box.y_end) * 128;
  return microtin_segment{x, y, x, y};
}

// The tiles whose closed boxes a legal segment meets, row by row from where it begins. Looks at no
// more than twice as many boxes as its bounding box has columns and rows, together, also after
// go_to.
class TouchedTiles {
 public:
  MICROTIN_ONE_COPY TouchedTiles(const TileGrid& grid, const microtin_segment& segment)
      : grid_(grid),
        segment_(segment),
        columns_(slices(segment.x, segment.x_end, grid.width, grid.x_max)),
        rows_(slices(segment.y, segment.y_end, grid.height, grid.y_max)),
        rises_right_((segment.x_end < segment.x) == (segment.y_end < segment.y)),
        column_(columns_.from),
        row_(rows_.from),
        first_(columns_.from),
        is_met_(false),
        at_end_(columns_.none || rows_.none) {
    seek();
  }

  bool at_end() const { return at_end_; }
  uint32_t number() const { return row_ * tile_columns(grid_) + column_; }
  TileBox box() const { return tile_box(grid_, number()); }

  void next() {
    if (!is_met_) first_ = column_;
    is_met_ = true;
    step();
    seek();
  }

  // Goes to a tile of the grid at once. False if the segment does not meet it: then the walk is
  // over.
  MICROTIN_ONE_COPY MICROTIN_OUT_OF_LINE bool go_to(uint32_t tile) {
    row_ = tile / tile_columns(grid_);
    column_ = tile % tile_columns(grid_);
    at_end_ = !columns_.holds(column_) || !rows_.holds(row_) || side() != Side::kOn;
    // The next row's boxes begin at most one column before any that is met in this one, but on a
    // segment along the border between the two.
    // Nothing is before a column that the segment does not reach; the walk is over then.
    const bool is_first = segment_.y == segment_.y_end || column_ == columns_.from || at_end_;
    first_ = is_first ? columns_.from : columns_.before(column_);
    is_met_ = true;
    return !at_end_;
  }

 private:
  enum class Side { kLeft, kOn, kRight };

  // Where a box is, seen along the segment. Its corners are within 2^25 of the beginning, the end
  // within 2^24.
  Side side() const {
    const TileBox b = box();
    const LocalPoint begin = local(b, segment_.x, segment_.y),
                     end = local(b, segment_.x_end, segment_.y_end),
                     size = {static_cast<int32_t>(b.x_end - b.x) * 256,
                             static_cast<int32_t>(b.y_end - b.y) * 256};
    bool some_left = false, some_right = false;
    for (uint32_t i = 0; i < 4; ++i) {
      const int64_t corner =
          orient(begin, end, LocalPoint{(i & 1u) != 0 ? size.x : 0, (i & 2u) != 0 ? size.y : 0});
      some_left = some_left || corner >= 0;
      some_right = some_right || corner <= 0;
    }
    return !some_left ? Side::kRight : some_right ? Side::kOn : Side::kLeft;
  }

  // To a box that the segment meets. A row's are neighbours: those before them are on one side of
  // the segment, those behind on the other.
  void seek() {
    const Side behind = rises_right_ ? Side::kRight : Side::kLeft;
    while (!at_end_) {
      const Side here = side();
      if (here == Side::kOn) return;
      if (here == behind) {
        next_row();
      } else {
        step();
      }
    }
  }

  // Where a whole row lies before the segment, all that follow do, too.
  void step() {
    if (column_ != columns_.to) {
      column_ = columns_.after(column_);
    } else if (is_met_) {
      next_row();
    } else {
      at_end_ = true;
    }
  }

  // A segment never turns back: no box of the next row lies before the first of this one.
  void next_row() {
    column_ = first_;
    is_met_ = false;
    at_end_ = row_ == rows_.to;
    if (!at_end_) row_ = rows_.after(row_);
  }

  // Columns or rows, in the direction of the segment.
  struct Slices {
    uint32_t from, to;
    bool none;

    uint32_t after(uint32_t i) const { return from < to ? i + 1 : i - 1; }
    uint32_t before(uint32_t i) const { return from < to ? i - 1 : i + 1; }
    bool holds(uint32_t i) const {
      return !none && (from < to ? from <= i && i <= to : to <= i && i <= from);
    }
  };

  static Slices slices(int64_t begin, int64_t end, uint32_t size, uint32_t most) {
    const int64_t limit = static_cast<int64_t>(most) * 256;
    int64_t low = begin < end ? begin : end, high = begin < end ? end : begin;
    if (high < 0 || low > limit) return Slices{0, 0, true};
    if (low < 0) low = 0;
    if (high > limit) high = limit;
    uint32_t first = static_cast<uint32_t>(low >> 8) / size;
    if (first != 0 && static_cast<int64_t>(first) * size * 256 == low) --first;
    const uint32_t reached = static_cast<uint32_t>(high >> 8) / size, final = (most - 1) / size;
    const uint32_t last = reached < final ? reached : final;
    return begin <= end ? Slices{first, last, false} : Slices{last, first, false};
  }

  const TileGrid& grid_;
  const microtin_segment& segment_;
  Slices columns_, rows_;
  bool rises_right_;  // or falls left: along a row the boxes to the left of the segment come first
  uint32_t column_, row_;
  uint32_t first_;  // column of the first box met in this row, or in the last one that has any
  bool is_met_;     // a box of this row is among them
  bool at_end_;
};

}  // namespace microtin

#endif
