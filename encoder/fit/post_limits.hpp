// SPDX-License-Identifier: MIT
// What each post allows, as numbers that are quick to compare with.
#ifndef MICROTIN_ENCODER_FIT_POST_LIMITS_HPP
#define MICROTIN_ENCODER_FIT_POST_LIMITS_HPP

#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/fit/error_model.hpp"
#include "encoder/fit/post_index.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/survey.hpp"
#include "shared/predicates.hpp"

namespace microtin::fit {

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
