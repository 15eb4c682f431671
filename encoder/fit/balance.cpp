// SPDX-License-Identifier: MIT
// Weights of vertices in the means, from the places of posts in their triangles.
#include "encoder/fit/balance.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace microtin::fit {
namespace {

// Means that are near enough to zero, in radii.
constexpr double kTolerance = 0.01, kFlatTolerance = 0.07;
constexpr double kCentred = 0.02;  // that of all posts, without moving vertices

constexpr std::size_t kLargeParts = 32;  // flat parts with that part of all posts
constexpr double kOneSided = 0.25;       // middles so far above the source, in radii

// Sets of samples that are joined two by two.
class Sets {
 public:
  explicit Sets(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0u); }

  uint32_t of(uint32_t sample) {
    while (parent_[sample] != sample) {
      parent_[sample] = parent_[parent_[sample]];
      sample = parent_[sample];
    }
    return sample;
  }

  void join(uint32_t a, uint32_t b) {
    const uint32_t first = of(a), second = of(b);
    parent_[std::max(first, second)] = std::min(first, second);
  }

 private:
  std::vector<uint32_t> parent_;
};

// Joins samples side by side that have one height; they are in lexicographic order.
Sets flat_sets(const std::vector<Sample>& samples) {
  Sets sets(samples.size());
  uint32_t east = 0;
  for (uint32_t i = 0; i < samples.size(); ++i) {
    const Sample& here = samples[i];
    const auto join = [&](uint32_t other, int dx, int dy) {
      if (other >= samples.size()) return;
      const Sample& there = samples[other];
      const bool beside = there.place.x == here.place.x + dx && there.place.y == here.place.y + dy;
      if (beside && there.height == here.height) sets.join(i, other);
    };
    join(i + 1, 0, 1);
    const auto is_before = [&](Point p) {
      return p.x < here.place.x + 1 || (p.x == here.place.x + 1 && p.y < here.place.y);
    };
    while (east < samples.size() && is_before(samples[east].place)) ++east;
    join(east, 1, 0);
  }
  return sets;
}

// Whether the middle of what is allowed is above the source.
bool is_one_sided(const Surface& surface, double radius) {
  double above = 0;
  for (std::size_t i = 0; i < surface.posts().size(); ++i) {
    above += double{surface.middles()[i]} -
             surface.survey().samples[surface.posts().number(i)].height / 65536.0;
  }
  return above > kOneSided * radius * static_cast<double>(surface.posts().size());
}

}  // namespace

Balance::Balance(const Surface& surface, double weight)
    : shares_(surface.vertex_limit()), radius_(surface.mean_radius()), weight_(weight) {
  const PostIndex& posts = surface.posts();
  if (radius_ == 0 || is_one_sided(surface, radius_)) return;
  find_parts(surface.survey());
  std::vector<bool> met(posts.size());
  surface.visit_covered([&](Index triangle) { add_face(surface, triangle, met); });
  for (const std::vector<Share>& shares : shares_) {
    for (const Share& share : shares) ++parts_[share.part].vertices;
  }
}

void Balance::find_parts(const Survey& survey) {
  Sets sets = flat_sets(survey.samples);
  std::vector<uint32_t> size(survey.samples.size()), number(survey.samples.size());
  for (uint32_t i = 0; i < size.size(); ++i) ++size[sets.of(i)];
  parts_.push_back({0, 0, kTolerance * radius_, 0});
  for (uint32_t i = 0; i < size.size(); ++i) {
    if (size[i] * kLargeParts < size.size()) continue;
    number[i] = static_cast<uint32_t>(parts_.size());
    parts_.push_back({0, 0, kFlatTolerance * radius_, 0});
  }
  for (uint32_t i = 0; i < size.size(); ++i) part_.push_back(number[sets.of(i)]);
}

// Posts on the border of several faces count in the first.
void Balance::add_face(const Surface& surface, Index triangle, std::vector<bool>& met) {
  const Index* const corner = surface.mesh().origin + first_edge(triangle);
  const Point a = surface.place(corner[0]), b = surface.place(corner[1]),
              c = surface.place(corner[2]);
  const auto area = static_cast<double>(orient2d(a, b, c));
  const PostIndex& posts = surface.posts();
  posts.visit_runs(a, b, c, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (met[i]) continue;
      met[i] = true;
      const Point p = posts.place(i);
      const uint32_t sample = posts.number(i);
      const double of_b = static_cast<double>(orient2d(c, a, p)) / area;
      const double of_c = static_cast<double>(orient2d(a, b, p)) / area;
      const double weight[3] = {1 - of_b - of_c, of_b, of_c};
      double error = surface.survey().samples[sample].height / -65536.0;
      for (int k = 0; k < 3; ++k) error += weight[k] * surface.height(corner[k]);
      add_error(0, error, corner, weight);
      if (part_[sample] != 0) add_error(part_[sample], error, corner, weight);
    }
  });
}

void Balance::add_error(uint32_t part, double error, const Index* corner, const double* weight) {
  parts_[part].sum += error;
  parts_[part].posts += 1;
  for (int k = 0; k < 3; ++k) {
    std::vector<Share>& shares = shares_[corner[k]];
    const auto same = [&](const Share& share) { return share.part == part; };
    const auto at = std::find_if(shares.begin(), shares.end(), same);
    if (at != shares.end()) {
      at->weight += weight[k];
    } else {
      shares.push_back({part, weight[k]});
    }
  }
}

// How far a mean is off, squared, beyond what is near enough, if its sum changes.
double Balance::excess(const Part& part, double change) const {
  const double mean = std::abs(part.sum + change) / part.posts;
  const double beyond = std::max(mean - part.tolerance, 0.0) / radius_;
  return beyond * beyond;
}

double Balance::price(Index v, int32_t steps) const {
  double price = 0;
  for (const Share& share : shares_[v]) {
    const Part& part = parts_[share.part];
    const double change = excess(part, share.weight * steps) - excess(part, 0);
    price += weight_ * part.vertices * change;
  }
  return price;
}

void Balance::move(Index v, int32_t steps) {
  for (const Share& share : shares_[v]) parts_[share.part].sum += share.weight * steps;
}

bool Balance::is_centred() const {
  return std::abs(mean()) <= kCentred * radius_;
}

bool Balance::is_kept() const {
  return std::all_of(parts_.begin(), parts_.end(),
                     [this](const Part& part) { return excess(part, 0) == 0; });
}

}  // namespace microtin::fit
