// SPDX-License-Identifier: MIT
// Weights of vertices in the means, from the places of posts in their triangles.
#include <algorithm>
#include <cmath>
#include <optional>

#include "encoder/fit/height_choice.hpp"

namespace microtin::fit {
namespace {

// Means that are near enough to zero, in radii.
constexpr double kTolerance = 0.01, kFlatTolerance = 0.07;
constexpr double kCentred = 0.02;  // that of all posts, without moving vertices

constexpr std::size_t kLargeParts = 32;  // flat parts with that part of all posts: no more of them
constexpr double kOneSided = 0.25;       // middles so far above the source, in radii

// Heights that enough samples have for a large part. They are counted by hashes: where some agree,
// it may be that none has.
class CommonHeights {
 public:
  explicit CommonHeights(const std::vector<Sample>& samples)
      : counts_(std::size_t{1} << kBits), all_(samples.size()) {
    for (const Sample& sample : samples) ++counts_[hash(sample.height)];
  }
  bool has(int32_t height) const { return counts_[hash(height)] * kLargeParts >= all_; }

 private:
  static constexpr int kBits = 16;
  static std::size_t hash(int32_t height) {
    constexpr uint32_t kGolden = 2654435769U;
    return static_cast<uint32_t>(height) * kGolden >> (32 - kBits);
  }

  std::vector<uint32_t> counts_;
  std::size_t all_;
};

// Samples side by side that have one height.
class FlatParts {
 public:
  explicit FlatParts(const Surface& surface)
      : posts_(surface.posts()), samples_(surface.survey().samples) {}

  // Visits those that hang together with this one, as far as visit(sample) says that it is new
  // there, and returns how many are. In steps outwards: few are in hand at a time.
  template <class Visit>
  std::size_t spread(uint32_t from, const Visit& visit) {
    std::size_t size = 0;
    visit(from);
    for (edge_ = {from}; !edge_.empty(); edge_.swap(next_)) {
      size += edge_.size();
      next_.clear();
      for (const uint32_t sample : edge_) {
        for (const Step step : {Step{-1, 0}, Step{1, 0}, Step{0, -1}, Step{0, 1}}) {
          const std::optional<uint32_t> beside = sample_beside(samples_[sample], step);
          if (beside && visit(*beside)) next_.push_back(*beside);
        }
      }
    }
    return size;
  }

 private:
  struct Step {
    int x, y;
  };

  // The sample there, if it has the same height.
  std::optional<uint32_t> sample_beside(const Sample& sample, Step step) const {
    const int x = sample.place.x + step.x, y = sample.place.y + step.y;
    if (std::min(x, y) < 0 || std::max(x, y) > kLatticeMax) return std::nullopt;
    const auto post = posts_.find({static_cast<uint16_t>(x), static_cast<uint16_t>(y)});
    if (!post || samples_[posts_.number(*post)].height != sample.height) return std::nullopt;
    return posts_.number(*post);
  }

  const PostIndex& posts_;
  const std::vector<Sample>& samples_;
  std::vector<uint32_t> edge_, next_;
};

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
    : first_(surface.vertex_limit(), kNone), radius_(surface.mean_radius()), weight_(weight) {
  const PostIndex& posts = surface.posts();
  if (radius_ == 0 || is_one_sided(surface, radius_)) return;
  const std::vector<uint8_t> part_of = find_parts(surface);
  std::vector<bool> met(posts.size());
  shares_.reserve(surface.vertices());
  surface.visit_covered([&](Index triangle) { add_face(surface, triangle, part_of, met); });
  for (const Share& share : shares_) ++parts_[share.part].vertices;
}

std::vector<uint8_t> Balance::find_parts(const Surface& surface) {
  const std::vector<Sample>& samples = surface.survey().samples;
  parts_.push_back({0, 0, kTolerance * radius_, 0});
  const CommonHeights common(samples);
  FlatParts flat(surface);
  std::vector<uint8_t> part_of(samples.size());
  std::vector<bool> met(samples.size());
  const auto is_new = [&](uint32_t sample) {
    const bool was_met = met[sample];
    met[sample] = true;
    return !was_met;
  };
  for (uint32_t i = 0; i < samples.size(); ++i) {
    if (met[i] || !common.has(samples[i].height)) continue;
    if (flat.spread(i, is_new) * kLargeParts < samples.size()) continue;
    const auto part = static_cast<uint8_t>(parts_.size());
    parts_.push_back({0, 0, kFlatTolerance * radius_, 0});
    flat.spread(i, [&](uint32_t sample) {
      const bool was_part = part_of[sample] == part;
      part_of[sample] = part;
      return !was_part;
    });
  }
  return part_of;
}

// Posts on the border of several faces count in the first.
void Balance::add_face(const Surface& surface, Index triangle, const std::vector<uint8_t>& part_of,
                       std::vector<bool>& met) {
  const Index* const corner = surface.mesh().origin + first_edge(triangle);
  const Point a = surface.place(corner[0]), b = surface.place(corner[1]),
              c = surface.place(corner[2]);
  const auto area = static_cast<double>(orient2d(a, b, c));
  const PostIndex& posts = surface.posts();
  posts.visit_runs(a, b, c, [&](const PostIndex::Run& run) {
    for (std::size_t i = run.first; i < run.last; ++i) {
      if (met[i]) continue;
      met[i] = true;
      const Point p = posts.place_in(run, i);
      const uint32_t sample = posts.number(i);
      const double of_b = static_cast<double>(orient2d(c, a, p)) / area;
      const double of_c = static_cast<double>(orient2d(a, b, p)) / area;
      const double weight[3] = {1 - of_b - of_c, of_b, of_c};
      double error = surface.survey().samples[sample].height / -65536.0;
      for (int k = 0; k < 3; ++k) error += weight[k] * surface.height(corner[k]);
      add_error(0, error, corner, weight);
      if (part_of[sample] != 0) add_error(part_of[sample], error, corner, weight);
    }
  });
}

void Balance::add_error(uint32_t part, double error, const Index* corner, const double* weight) {
  parts_[part].sum += error;
  parts_[part].posts += 1;
  for (int k = 0; k < 3; ++k) {
    uint32_t* at = &first_[corner[k]];
    while (*at != kNone && shares_[*at].part != part) at = &shares_[*at].next;
    if (*at != kNone) {
      shares_[*at].weight += weight[k];
    } else {
      *at = static_cast<uint32_t>(shares_.size());
      shares_.push_back({weight[k], part, kNone});
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
  for (uint32_t i = first_[v]; i != kNone; i = shares_[i].next) {
    const Share& share = shares_[i];
    const Part& part = parts_[share.part];
    const double change = excess(part, share.weight * steps) - excess(part, 0);
    price += weight_ * part.vertices * change;
  }
  return price;
}

void Balance::move(Index v, int32_t steps) {
  for (uint32_t i = first_[v]; i != kNone; i = shares_[i].next) {
    parts_[shares_[i].part].sum += shares_[i].weight * steps;
  }
}

bool Balance::is_centred() const {
  return std::abs(mean()) <= kCentred * radius_;
}

bool Balance::is_kept() const {
  return std::all_of(parts_.begin(), parts_.end(),
                     [this](const Part& part) { return excess(part, 0) == 0; });
}

}  // namespace microtin::fit
