// SPDX-License-Identifier: MIT
// What the search tries at one vertex: to remove it, to move it, to add another one.
#ifndef MICROTIN_ENCODER_FIT_ATTEMPTS_HPP
#define MICROTIN_ENCODER_FIT_ATTEMPTS_HPP

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/fit/height_fit.hpp"
#include "encoder/fit/surface.hpp"
#include "encoder/layers.hpp"
#include "encoder/stream/spatial_order.hpp"
#include "shared/format.hpp"
#include "shared/predicates.hpp"

namespace microtin::fit {

// Sequences from different seeds have nothing in common.
class RandomNumbers {
 public:
  explicit RandomNumbers(uint64_t seed) : state_(scramble(seed)) {}

  // 0 .. limit - 1, where limit is below 2^32.
  std::size_t below(std::size_t limit) {
    return static_cast<std::size_t>((scramble(++state_) >> 32) * limit >> 32);
  }

 private:
  uint64_t state_;
};

// The least rectangle around some places; empty at first.
class Region {
 public:
  void add(Point p) {
    low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
    high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
  }

  // Whether they share a place.
  bool meets(const Region& other) const {
    return std::max(low_.x, other.low_.x) <= std::min(high_.x, other.high_.x) &&
           std::max(low_.y, other.low_.y) <= std::min(high_.y, other.high_.y);
  }

 private:
  Point low_{kLatticeMax, kLatticeMax}, high_{0, 0};
};

// What an attempt changed.
struct Outcome {
  std::vector<Edits::Edit> edits;  // none if it failed
  std::vector<Index> vertices;     // which may be tried again, since something near them changed
  int64_t raised = 0;              // what the surface's volume became larger by
  bool is_removal = false;         // whether there is a vertex less
  Region region;                   // around all triangles that it changed or had to keep in bounds
};

// A vertex is removed if its neighbours find heights that keep all bounds around. If not, it may
// move to a post next to it whose place costs fewer bits, to a random one near it, or to one where
// the bound is missed, and then each of its new neighbours is tried; if none of them can go, it
// stays there nevertheless, so that the search does not get stuck. Places are cheap where both
// coordinates are multiples of two.
//
// An attempt that succeeded may be repeated on another surface that has the same vertices within
// its region. Triangles that it replaces or makes have all corners there; so another insertion or
// removal that has to do with one of them shares two corners with it, and its region meets this.
class Attempts {
 public:
  // The surface keeps its bounds and must outlive this.
  explicit Attempts(Surface& surface);

  // How likely an odd coordinate is replaced by an even one, 0 .. 1.
  void set_cheapness(double cheapness) { cheapness_ = cheapness; }

  // The mean area around a vertex, twice.
  void set_usual_area(int64_t area) { usual_area_ = area; }

  // Heights that are free go up or down (1, -1; 0: to the source), and volume in this direction is
  // what attempts gain.
  void prefer(int32_t direction);

  // Begins an attempt with random numbers of its own.
  void begin(uint64_t seed);

  // Each says whether there is a vertex less.
  bool remove_vertex(Index v);
  bool move_vertex(Index v);
  // To a post whose place costs no more and which is at most so near, along x and y together, if
  // that gains. Of some of these posts it takes that which gains most.
  bool move_and_gain(Index v, int near);

  // A vertex that could be added near another, and what that gains.
  struct Addition {
    int64_t gain;
    Vertex vertex;
    Index corner;
  };
  // The best one in a triangle; changes nothing.
  std::optional<Addition> addition_in(const std::array<Index, 3>& corners);
  // Says whether it gains at least half as much as it did; else nothing has changed.
  bool add(const Addition& addition);

  // What was done since `begin`.
  Outcome outcome(bool is_removal) const;

  // All attempts so far stay, or none does.
  void keep() { edits_.commit(); }
  void take_back() { edits_.roll_back(0); }

 private:
  // Where a vertex was removed.
  struct Hole {
    std::vector<Index> ring;  // its neighbours
    int64_t raised;           // what the surface's volume became larger by
  };

  bool is_passed_over(Index v);
  bool move_near(Vertex old, int near, const Hole& hole);
  int64_t gain() const { return direction_ * raised_; }
  bool try_cheaper_posts(Vertex old, const Hole& hole);
  bool try_near(Vertex old, const Hole& hole);
  bool try_post(Point to, Vertex old, const Hole& hole);
  bool place(Vertex vertex, const Hole& hole);
  bool insert(Vertex vertex, const Hole& hole);
  std::optional<Vertex> carried(Vertex old, int x, int y) const;
  uint16_t cheap(uint16_t coordinate);
  int16_t nearest_height(std::size_t post) const;
  bool fit(const std::vector<Index>& vertices);
  std::vector<Index> ring(Index v) const;
  std::optional<Hole> remove(Index v);

  Surface& surface_;
  Edits edits_;
  std::size_t first_ = 0;  // edit of the attempt in hand
  HeightFit fit_;
  std::vector<Index> fitted_;  // by the attempt in hand
  int64_t raised_ = 0;         // by it: what the volume became larger by
  Index moved_ = 0;            // inserted last
  double cheapness_ = 0;
  int64_t usual_area_ = 0;
  int32_t direction_ = 0;
  RandomNumbers random_{0};
};

}  // namespace microtin::fit

#endif
