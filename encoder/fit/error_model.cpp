// SPDX-License-Identifier: MIT
// Limits of posts, and planes to compare with them.
#include "encoder/fit/error_model.hpp"

#include <algorithm>

namespace microtin::fit {

PostLimits::PostLimits(const Survey& survey, const ErrorModel& model, const PostIndex& posts) {
  middles.reserve(posts.size() + PostIndex::kReadAhead);
  radii.reserve(posts.size() + PostIndex::kReadAhead);
  for (std::size_t i = 0; i < posts.size(); ++i) {
    const auto [middle, radius] = model.middle_and_radius(survey.samples[posts.number(i)]);
    middles.push_back(static_cast<float>(middle));
    radii.push_back(static_cast<float>(radius));
    if (radius >= ErrorModel::kUnboundedRadius) continue;
    ++bounded_posts;
    mean_radius += static_cast<double>(radii.back());
    while (4 * widest_stride < radius && widest_stride < 4096) widest_stride *= 2;
  }
  mean_radius /= static_cast<double>(std::max<std::size_t>(bounded_posts, 1));
  middles.resize(posts.size() + PostIndex::kReadAhead);
  radii.resize(posts.size() + PostIndex::kReadAhead);
}

Plane::Plane(Vertex a, Vertex b, Vertex c) : a_(a) {
  const auto area = static_cast<double>(orient2d({a.x, a.y}, {b.x, b.y}, {c.x, c.y}));
  const double bx = b.x - a.x, by = b.y - a.y, bz = b.z - a.z;
  const double cx = c.x - a.x, cy = c.y - a.y, cz = c.z - a.z;
  along_x_ = (bz * cy - cz * by) / area;
  along_y_ = (cz * bx - bz * cx) / area;
}

}  // namespace microtin::fit
