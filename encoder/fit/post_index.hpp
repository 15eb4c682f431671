// SPDX-License-Identifier: MIT
// Which posts lie under a triangle.
#ifndef MICROTIN_ENCODER_FIT_POST_INDEX_HPP
#define MICROTIN_ENCODER_FIT_POST_INDEX_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/layers.hpp"
#include "shared/predicates.hpp"

namespace microtin::fit {

// Posts sorted into square cells, about as many cells as posts: on a raster one post a cell, whose
// triangles are then scanned column by column without a test.
class PostIndex {
 public:
  // `places` are distinct. Linear.
  explicit PostIndex(const std::vector<Point>& places);

  // Calls visit(i, place) for every place i in the closed counter-clockwise triangle.
  template <class Visit>
  void visit_under(Point a, Point b, Point c, const Visit& visit) const {
    if (posts_.empty()) return;
    const Outline outline(a, b, c);
    const uint32_t last = std::min<uint32_t>(outline.right().x / cell_, columns_ - 1);
    for (uint32_t column = outline.left().x / cell_; column <= last; ++column) {
      const int64_t x = int64_t{column} * cell_;
      const Outline::Span span = outline.over(x, x + cell_ - 1);
      if (span.low > span.high || span.low / cell_ >= rows_) continue;
      const uint32_t* const cells = first_.data() + std::size_t{column} * rows_;
      const auto low = static_cast<std::size_t>(span.low / cell_);
      const auto high =
          std::min<std::size_t>(static_cast<std::size_t>(span.high / cell_), rows_ - 1);
      for (uint32_t i = cells[low]; i < cells[high + 1]; ++i) {
        const Post& post = posts_[i];
        if (cell_ == 1 || covers(a, b, c, post.place)) visit(post.number, post.place);
      }
    }
  }

 private:
  struct Post {
    Point place;
    uint32_t number;
  };

  // A triangle seen from below and above.
  class Outline {
   public:
    Outline(Point a, Point b, Point c) : corner_{a, b, c} {
      std::sort(corner_, corner_ + 3);
      bends_up_ = orient2d(corner_[0], corner_[2], corner_[1]) > 0;
    }

    Point left() const { return corner_[0]; }
    Point right() const { return corner_[2]; }

    struct Span {
      int64_t low, high;
    };

    // The whole y that the triangle reaches where x is in from .. to. Exact if from = to.
    Span over(int64_t from, int64_t to) const {
      from = std::max<int64_t>(from, corner_[0].x);
      to = std::min<int64_t>(to, corner_[2].x);
      Span span = at(from);
      if (from == to) return span;
      join(span, at(to));
      if (from < corner_[1].x && corner_[1].x < to) join(span, at(corner_[1].x));
      return span;
    }

   private:
    static void join(Span& span, Span other) {
      span.low = std::min(span.low, other.low);
      span.high = std::max(span.high, other.high);
    }

    Span at(int64_t x) const {
      const bool before = x < corner_[1].x;
      const Point from = corner_[before ? 0 : 1], to = corner_[before ? 1 : 2];
      if (bends_up_) return {ceil_at(corner_[0], corner_[2], x), floor_at(from, to, x)};
      return {ceil_at(from, to, x), floor_at(corner_[0], corner_[2], x)};
    }

    // The y of the line from p to q at x, rounded down; that of p if the line is vertical.
    static int64_t floor_at(Point p, Point q, int64_t x) {
      const int64_t width = int64_t{q.x} - p.x, rise = (int64_t{q.y} - p.y) * (x - p.x);
      if (width == 0) return p.y;
      return p.y + (rise >= 0 ? rise / width : -((width - 1 - rise) / width));
    }

    static int64_t ceil_at(Point p, Point q, int64_t x) {
      const int64_t width = int64_t{q.x} - p.x, rise = (int64_t{q.y} - p.y) * (x - p.x);
      if (width == 0) return p.y;
      return p.y + (rise >= 0 ? (rise + width - 1) / width : -(-rise / width));
    }

    Point corner_[3];
    bool bends_up_;
  };

  static bool covers(Point a, Point b, Point c, Point p) {
    return orient2d(a, b, p) >= 0 && orient2d(b, c, p) >= 0 && orient2d(c, a, p) >= 0;
  }

  uint32_t cell_ = 1, columns_ = 0, rows_ = 0;
  std::vector<Post> posts_;      // by column of cells, then row, then place
  std::vector<uint32_t> first_;  // of each cell, and one more
};

}  // namespace microtin::fit

#endif
