// SPDX-License-Identifier: MIT
// Which posts lie under a triangle.
#ifndef MICROTIN_ENCODER_FIT_POST_INDEX_HPP
#define MICROTIN_ENCODER_FIT_POST_INDEX_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/exact/wide.hpp"
#include "encoder/layers.hpp"
#include "shared/predicates.hpp"

namespace microtin::fit {

// Posts sorted into square cells, about as many cells as posts: on a raster one post a cell, whose
// triangles are then scanned column by column without a test. So are cells that hold many posts, of
// clouds with crowds far apart. A raster without holes takes no memory for its posts.
class PostIndex {
 public:
  // `places` are distinct. Linear, where they are in order or no cell holds many.
  explicit PostIndex(const std::vector<Point>& places);

  // Posts have positions, from 0 on: by column of cells, then row, then place.
  std::size_t size() const { return size_; }
  Point place(std::size_t position) const {
    return is_full_ ? place_in_full(position) : places_[position];
  }
  uint32_t number(std::size_t position) const {
    return numbers_.empty() ? static_cast<uint32_t>(position) : numbers_[position];
  }
  // The positions first .. last - 1, whose posts have the same x, and the place of the first.
  struct Run {
    std::size_t first, last;
    Point place;
  };

  // As `place`, of a position in a run, but quicker.
  Point place_in(const Run& run, std::size_t position) const {
    if (!is_full_) return places_[position];
    return {run.place.x, static_cast<uint16_t>(run.place.y + (position - run.first))};
  }

  // The y of places in a run, and kReadAhead numbers more.
  const float* rows_of(const Run& run) const {
    return rows_of_places_.data() + (is_full_ ? run.place.y - south_ : run.first);
  }
  static constexpr std::size_t kReadAhead = 4;

  // Calls visit(run), so that together the runs have all posts in the closed counter-clockwise
  // triangle.
  template <class Visit>
  void visit_runs(Point a, Point b, Point c, const Visit& visit) const {
    if (size_ == 0) return;
    const Outline outline(a, b, c);
    if (cell_ == 1) {
      visit_columns(outline, visit);
      return;
    }
    const uint32_t left = std::max<uint32_t>(outline.left().x, west_);
    const uint32_t right = std::min<uint32_t>(outline.right().x, east_);
    for (uint32_t x = left - (left - west_) % cell_; x <= right; x += cell_) {
      const Outline::Span span = within_rows(outline.over(x, int64_t{x} + cell_ - 1));
      if (span.low > span.high) continue;
      const std::size_t column = std::size_t{(x - west_) / cell_} * rows_;
      const std::size_t low = column + row_of(span.low), high = column + row_of(span.high);
      const auto test = [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
          if (covers(a, b, c, places_[i])) visit(Run{i, i + 1, places_[i]});
        }
      };
      if (!has_crowds_) {
        test(first_[low], first_[high + 1]);
        continue;
      }
      for (std::size_t cell = low; cell <= high; ++cell) {
        if (is_crowded(cell)) {
          visit_crowd(outline, x, cell, visit);
        } else {
          test(first_[cell], first_[cell + 1]);
        }
      }
    }
  }

  // Calls visit(i, place) for every place i in the closed counter-clockwise triangle.
  template <class Visit>
  void visit_under(Point a, Point b, Point c, const Visit& visit) const {
    visit_runs(a, b, c, [&](const Run& run) {
      for (std::size_t i = run.first; i < run.last; ++i) visit(number(i), place_in(run, i));
    });
  }

  // The position of the post at a place; nothing if there is none.
  std::optional<std::size_t> find(Point p) const;

 private:
  // A triangle seen from below and above.
  class Outline {
   public:
    // The y of a side at x, or of its first end if it is vertical. What is not a whole number is
    // 2^-16 away from one or more, and floating point less than 2^-30 from the truth; none is below
    // 0.
    class Line {
     public:
      Line() = default;
      Line(Point p, Point q)
          : from_(p), slope_(p.x == q.x ? 0 : (double{0} + q.y - p.y) / (q.x - p.x)) {}
      int64_t floor_at(int64_t x) const { return static_cast<int64_t>(at(x) + kLittle); }
      int64_t ceil_at(int64_t x) const { return static_cast<int64_t>(at(x) + (1 - kLittle)); }

     private:
      static constexpr double kLittle = 1.0 / (1 << 20);
      double at(int64_t x) const { return from_.y + slope_ * static_cast<double>(x - from_.x); }
      Point from_{0, 0};
      double slope_ = 0;
    };

    Outline(Point a, Point b, Point c) : corner_{a, b, c} {
      std::sort(corner_, corner_ + 3);
      bends_up_ = orient2d(corner_[0], corner_[2], corner_[1]) > 0;
      long_ = Line(corner_[0], corner_[2]);
      before_ = Line(corner_[0], corner_[1]);
      after_ = Line(corner_[1], corner_[2]);
    }

    Point left() const { return corner_[0]; }
    Point right() const { return corner_[2]; }

    // What lies between two sides, before or after the middle corner.
    struct Part {
      Line low, high;
      int64_t left, right;
    };
    Part part(bool is_after) const {
      const Line& bent = is_after ? after_ : before_;
      const Line &low = bends_up_ ? long_ : bent, &high = bends_up_ ? bent : long_;
      if (is_after) return {low, high, corner_[1].x, corner_[2].x};
      return {low, high, corner_[0].x, int64_t{corner_[1].x} - 1};
    }

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

    // The span at one x within the triangle.
    Span at(int64_t x) const {
      const Line& bent = x < corner_[1].x ? before_ : after_;
      if (bends_up_) return {long_.ceil_at(x), bent.floor_at(x)};
      return {bent.ceil_at(x), long_.floor_at(x)};
    }

   private:
    static void join(Span& span, Span other) {
      span.low = std::min(span.low, other.low);
      span.high = std::max(span.high, other.high);
    }

    Point corner_[3];
    bool bends_up_;
    Line long_, before_, after_;
  };

  // Visits the posts where a cell is a place: no post has to be tested.
  template <class Visit>
  void visit_columns(const Outline& outline, const Visit& visit) const {
    const auto rows = static_cast<int64_t>(rows_);
    for (const bool is_after : {false, true}) {
      const Outline::Part part = outline.part(is_after);
      const int64_t last = std::min<int64_t>(part.right, east_);
      for (int64_t x = std::max<int64_t>(part.left, west_); x <= last; ++x) {
        const int64_t low = std::max<int64_t>(part.low.ceil_at(x), south_);
        const int64_t high = std::min<int64_t>(part.high.floor_at(x), north_);
        if (low > high) continue;
        const auto begin = static_cast<std::size_t>((x - west_) * rows + low - south_);
        const std::size_t end = begin + static_cast<std::size_t>(high - low) + 1;
        if (is_full_) {
          visit(Run{begin, end, {static_cast<uint16_t>(x), static_cast<uint16_t>(low)}});
        } else if (first_[begin] != first_[end]) {
          visit(Run{first_[begin], first_[end], places_[first_[begin]]});
        }
      }
    }
  }

  // Visits the posts of a cell whose first column is at x.
  template <class Visit>
  void visit_crowd(const Outline& outline, uint32_t x, std::size_t cell, const Visit& visit) const {
    const uint32_t last = std::min<uint32_t>(outline.right().x, x + cell_ - 1);
    for (x = std::max<uint32_t>(outline.left().x, x); x <= last; ++x) {
      const Outline::Span span = outline.at(x);
      if (span.low > span.high) continue;
      const auto at = [x](int64_t y) {
        return Point{static_cast<uint16_t>(x), static_cast<uint16_t>(y)};
      };
      const auto from = places_.begin() + first_[cell], to = places_.begin() + first_[cell + 1];
      const auto begin = std::lower_bound(from, to, at(span.low));
      const auto end = std::upper_bound(begin, to, at(span.high));
      if (begin != end) {
        visit(Run{static_cast<std::size_t>(begin - places_.begin()),
                  static_cast<std::size_t>(end - places_.begin()), *begin});
      }
    }
  }

  // A search in each of its columns takes less than a look at every post.
  bool is_crowded(std::size_t cell) const { return first_[cell + 1] - first_[cell] > 2 * cell_; }

  Outline::Span within_rows(Outline::Span span) const {
    return {std::max<int64_t>(span.low, south_), std::min<int64_t>(span.high, north_)};
  }
  std::size_t row_of(int64_t y) const { return (static_cast<uint32_t>(y) - south_) / cell_; }
  std::size_t cell_of(Point p) const {
    return std::size_t{(p.x - west_) / cell_} * rows_ + row_of(p.y);
  }

  // A position, below 2^32, divided by at most 2^16 rows. The reciprocal is too large by at most 1,
  // so the product is too large by less than 2^-16: fractions are at least that far below 1.
  static constexpr int kReciprocalBits = 48;
  Point place_in_full(std::size_t position) const {
    const auto column = static_cast<std::size_t>(
        (Wide{static_cast<int64_t>(position)} * reciprocal_) >> kReciprocalBits);
    return {static_cast<uint16_t>(west_ + column),
            static_cast<uint16_t>(south_ + (position - column * rows_))};
  }

  void find_box(const std::vector<Point>& places);
  void fill_column();
  void sort(const std::vector<Point>& places);
  void sort_cells(const std::vector<Point>& places);

  static bool covers(Point a, Point b, Point c, Point p) {
    return orient2d(a, b, p) >= 0 && orient2d(b, c, p) >= 0 && orient2d(c, a, p) >= 0;
  }

  uint32_t west_ = 0, south_ = 0, east_ = 0, north_ = 0;  // of all places
  uint32_t cell_ = 1;                                     // a side
  std::size_t rows_ = 0;                                  // of cells
  bool has_crowds_ = false;
  std::size_t size_ = 0;
  bool is_full_ = false;       // each cell has a side of 1 and a post: position and cell agree
  int64_t reciprocal_ = 0;     // of the rows, with kReciprocalBits fractional bits; if full
  std::vector<Point> places_;  // by position; empty if full
  std::vector<float> rows_of_places_;  // by position; if full those of one column
  std::vector<uint32_t> numbers_;      // by position; empty if they agree
  std::vector<uint32_t> first_;        // position in each cell, and one more; empty if full
};

}  // namespace microtin::fit

#endif
