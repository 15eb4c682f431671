// SPDX-License-Identifier: MIT
// How far a surface may be from a sample, and how far off it is: exactly, and in numbers that are
// quick to compare with.
#ifndef MICROTIN_ENCODER_FIT_ERROR_MODEL_HPP
#define MICROTIN_ENCODER_FIT_ERROR_MODEL_HPP

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "encoder/exact/wide.hpp"
#include "encoder/fit/post_index.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/survey.hpp"
#include "shared/predicates.hpp"

namespace microtin::fit {

// Heights have 16 fractional bits, as in Survey.
struct ErrorModel {
  bool bounded;  // the surface must lie in a sample's lowest .. highest; otherwise at its height

  // The lowest and the highest height that the sample allows.
  std::pair<int32_t, int32_t> allowed(const Sample& sample) const {
    return bounded ? std::make_pair(sample.lowest, sample.highest)
                   : std::make_pair(sample.height, sample.height);
  }

  // The distance of a surface's height from what the sample allows.
  uint64_t violation(const Sample& sample, int32_t surface) const {
    const auto [lowest, highest] = allowed(sample);
    return static_cast<uint64_t>(
        std::max({int64_t{lowest} - surface, int64_t{surface} - highest, int64_t{0}}));
  }

  // The radius of a sample without a bound: no two heights are farther from each other.
  static constexpr double kUnboundedRadius = 65536;

  // The middle of what the sample allows and the distance of its ends from there, in steps.
  std::pair<double, double> middle_and_radius(const Sample& sample) const {
    if (bounded && sample.is_unbounded()) return {sample.height / 65536.0, kUnboundedRadius};
    const auto [low, high] = allowed(sample);
    const double lowest = low, highest = high;
    return {(highest + lowest) / 131072, (highest - lowest) / 131072};
  }

  // The whole step nearest to the middle of what the sample allows (halves up) that is allowed.
  int16_t vertex_height(const Sample& sample) const {
    const int64_t twice_middle = bounded && !sample.is_unbounded()
                                     ? int64_t{sample.lowest} + sample.highest
                                     : int64_t{sample.height} * 2;
    return nearest_height(sample, round_divide(twice_middle, 131072));
  }

  // The allowed step that is nearest to a height in steps; any is allowed without bounds.
  int16_t nearest_height(const Sample& sample, Wide height) const {
    Wide lowest = std::numeric_limits<int16_t>::min();
    Wide highest = std::numeric_limits<int16_t>::max();
    if (bounded) {
      lowest = std::max(lowest, ceil_divide(sample.lowest, 65536));
      highest = std::min(highest, floor_divide(sample.highest, 65536));
    }
    return static_cast<int16_t>(std::min(std::max(height, lowest), highest));
  }
};

struct PostLimits {
  PostLimits(const Survey& survey, const ErrorModel& model, const PostIndex& posts);

  // The middle of what a post allows, and how far from there its ends are, in steps: by position
  // in the index, and PostIndex::kReadAhead numbers more. They are rounded to 24 bits, by at most
  // 2^-10 and 2^-9 steps.
  std::vector<float> middles, radii;

  // How many posts have a bound, and the mean of their radii.
  std::size_t bounded_posts = 0;
  double mean_radius = 0;

  // Steps that are worth a try where bounds are so wide: a power of two.
  int32_t widest_stride = 1;
};

// Steps by which a height on a Plane may be nearer to the end of such limits, or farther from it,
// than the exact height is to what the post allows.
constexpr double kLimitError = 1.0 / 64;

// A triangle's height in floating point.
class Plane {
 public:
  Plane(Vertex a, Vertex b, Vertex c);

  double at(Point p) const { return a_.z + along_x_ * (p.x - a_.x) + along_y_ * (p.y - a_.y); }

 private:
  Vertex a_;
  double along_x_, along_y_;
};

}  // namespace microtin::fit

#endif
