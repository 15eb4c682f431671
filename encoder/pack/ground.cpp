// SPDX-License-Identifier: MIT
// Means of squares by sums over rectangles from a corner; of noise as many posts as possible, of
// hills as few.
#include "encoder/pack/ground.hpp"

#include <algorithm>
#include <limits>

#include "encoder/pack/border_line.hpp"

namespace microtin::pack {

Ground::Ground(const std::vector<Sample>& samples, uint32_t width, uint32_t height)
    : width_(width), height_(height), sums_(std::size_t{width + 1} * (height + 1)) {
  const std::size_t row = std::size_t{width} + 1;
  for (const Sample& sample : samples) {
    sums_[(sample.place.y + std::size_t{1}) * row + sample.place.x + 1] = {middle_of(sample), 1};
  }
  for (std::size_t i = row; i < sums_.size(); ++i) {
    const bool begins = i % row == 0;
    const Sum west = begins ? Sum{} : sums_[i - 1], south = sums_[i - row];
    const Sum both = begins ? Sum{} : sums_[i - row - 1];
    sums_[i].heights += west.heights + south.heights - both.heights;
    sums_[i].posts += west.posts + south.posts - both.posts;
  }
}

Ground::Sum Ground::sum(uint32_t x, uint32_t y, uint32_t reach_x, uint32_t reach_y) const {
  const Sum &a = corner(x - reach_x, y - reach_y), &b = corner(x + reach_x + 1, y - reach_y),
            &c = corner(x - reach_x, y + reach_y + 1),
            &d = corner(x + reach_x + 1, y + reach_y + 1);
  return {d.heights - c.heights - b.heights + a.heights, d.posts - c.posts - b.posts + a.posts};
}

int32_t Ground::at(uint32_t x, uint32_t y, int64_t tolerance) const {
  const uint32_t most_x = std::min(x, width_ - 1 - x), most_y = std::min(y, height_ - 1 - y);
  int64_t mean = 0, lowest = std::numeric_limits<int32_t>::min(),
          highest = std::numeric_limits<int32_t>::max();
  for (uint32_t reach = 0; reach <= kGroundReach; ++reach) {
    const uint32_t reach_x = std::min(reach, most_x), reach_y = std::min(reach, most_y);
    const Sum all = sum(x, y, reach_x, reach_y);
    const int64_t posts = int64_t{2 * reach_x + 1} * (2 * reach_y + 1);
    if (all.posts != posts) break;
    const int64_t wider = all.heights / posts;
    if (wider < lowest || wider > highest) break;
    mean = wider;
    if (reach == 0) continue;
    lowest = std::max(lowest, mean - tolerance);
    highest = std::min(highest, mean + tolerance);
  }
  return static_cast<int32_t>(mean);
}

}  // namespace microtin::pack
