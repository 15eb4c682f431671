// SPDX-License-Identifier: MIT
// A part of the lattice.
#ifndef MICROTIN_ENCODER_FIT_REGION_HPP
#define MICROTIN_ENCODER_FIT_REGION_HPP

#include <algorithm>

#include "encoder/layers.hpp"
#include "shared/format.hpp"
#include "shared/predicates.hpp"

namespace microtin::fit {

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

}  // namespace microtin::fit

#endif
