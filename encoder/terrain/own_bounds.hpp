// SPDX-License-Identifier: MIT
// The bound of each post or point, where one bound does not hold for all.
#ifndef MICROTIN_ENCODER_TERRAIN_OWN_BOUNDS_HPP
#define MICROTIN_ENCODER_TERRAIN_OWN_BOUNDS_HPP

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "encoder/exact/decimal.hpp"
#include "encoder/layers.hpp"

namespace microtin::terrain {

// The number of a post without a bound: the surface may be anywhere, if it covers the post.
constexpr int64_t kUnbounded = std::numeric_limits<int64_t>::min();

// The bounds of a source's posts or points, in the order of its heights.
struct OwnBounds {
  std::vector<int64_t> numbers;  // times 10^-decimals, from 0 up; empty: max_error holds for all
  int decimals = 0;
  std::optional<Decimal> unscaled = {};  // the max_error at which they hold; another scales them

  bool empty() const { return numbers.empty(); }
};

// Bounds without their numbers: `unscaled` still shows that posts have bounds of their own.
inline OwnBounds frame_of(const OwnBounds& bounds) {
  return {{}, bounds.decimals, bounds.unscaled};
}

// What posts with bounds of their own have in common.
struct BoundSpan {
  uint64_t bounded = 0, unbounded = 0;  // posts or points
  Decimal least, largest;               // bounds
  Decimal ratio;  // largest, of a post's error to its bound if that is above 0, rounded up

  void add(const BoundSpan& other);
};

// The bound of each post, as a whole number of units of 10^-decimals, rounded down.
class BoundOf {
 public:
  static constexpr Wide kNone = -1;

  // max_error has at most as many decimals; without it no post has a bound. `own` must outlive it.
  BoundOf(const OwnBounds& own, const std::optional<Decimal>& max_error, int decimals);

  // kNone: the post has no bound.
  Wide operator()(std::size_t post) const {
    return own_.empty() || all_ == kNone ? all_ : own_bound(own_.numbers[post]);
  }

 private:
  Wide own_bound(int64_t number) const;

  const OwnBounds& own_;
  Wide all_;
  Wide factor_ = 1, divisor_ = 1;  // from a number to its bound
};

// The least bound above 0 of all posts, rounded down at 6 decimals if it is larger; max_error where
// none has a bound of its own.
Decimal least_bound(const OwnBounds& own, Decimal max_error);

// Compares the errors of posts with bounds of their own, both in billionths of a unit.
class BoundMeter {
 public:
  void add(Wide error, Wide bound);

  bool keeps_all() const { return keeps_all_; }
  BoundSpan span() const;

 private:
  uint64_t bounded_ = 0, unbounded_ = 0;
  Wide least_ = 0, largest_ = 0, ratio_ = 0;
  bool keeps_all_ = true;
};

}  // namespace microtin::terrain

#endif
