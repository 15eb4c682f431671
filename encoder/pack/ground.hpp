// SPDX-License-Identifier: MIT
// The ground around posts, without its noise.
#ifndef MICROTIN_ENCODER_PACK_GROUND_HPP
#define MICROTIN_ENCODER_PACK_GROUND_HPP

#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/terrain/survey.hpp"

namespace microtin::pack {

// How many posts around one count, in each direction.
constexpr uint32_t kGroundReach = 8;

// The ground: means of the middles of a rectangle's samples.
class Ground {
 public:
  // At most 2^24 posts.
  Ground(const std::vector<Sample>& samples, uint32_t width, uint32_t height);

  // The mean of the largest square around a post, which is not void, that tells of no other ground
  // than smaller ones: means do not differ by more than `tolerance`. Where the rectangle ends, or a
  // void is, squares end. O(1).
  int32_t at(uint32_t x, uint32_t y, int64_t tolerance) const;

 private:
  struct Sum {
    int64_t heights, posts;
  };
  Sum sum(uint32_t x, uint32_t y, uint32_t reach_x, uint32_t reach_y) const;
  const Sum& corner(uint32_t x, uint32_t y) const {
    return sums_[std::size_t{y} * (width_ + 1) + x];
  }

  uint32_t width_, height_;
  std::vector<Sum> sums_;  // of all posts to the south-west of a corner
};

}  // namespace microtin::pack

#endif
