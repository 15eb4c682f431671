// SPDX-License-Identifier: MIT
// Shifts heights until no post is out of bounds, or gives up soon.
#include "encoder/fit/height_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace microtin::fit {
namespace {

constexpr uint32_t kFixed = ~uint32_t{0};
constexpr uint32_t kMostSteps = 30;
constexpr double kNegligible = 1e-8;  // excess, in squared steps

// Several numbers at once.
constexpr std::size_t kLanes = 4;
typedef float Lanes __attribute__((vector_size(kLanes * sizeof(float))));

Lanes load(const float* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

}  // namespace

HeightFit::HeightFit(const Surface& surface)
    : surface_(surface), mover_(surface.vertex_limit(), kFixed), met_(surface.mesh().triangles) {}

bool HeightFit::fit(const std::vector<Index>& vertices) {
  collect(vertices);
  for (stride_ = surface_.widest_stride(); stride_ != 0; stride_ /= 2) {
    if (excess() <= kNegligible) return true;
    for (Face& face : faces_) evaluate(face);
    for (uint32_t steps = 0; steps < kMostSteps; ++steps) {
      const Step step = best_step();
      if (step.shift == 0) break;
      take(step);
      if (excess() <= kNegligible) return true;
    }
  }
  return false;
}

void HeightFit::collect(const std::vector<Index>& vertices) {
  ++call_;
  posts_ = 0;
  faces_.clear();
  triangles_.clear();
  mover_count_ = vertices.size();
  if (movers_.size() < mover_count_) movers_.resize(mover_count_);
  for (uint32_t i = 0; i < mover_count_; ++i) {
    movers_[i].shift = 0;
    movers_[i].corners.clear();
    mover_[vertices[i]] = i;
  }
  for (const Index v : vertices) {
    surface_.visit_around(v, [this](Index h) { add_face(triangle_of(h)); });
  }
  for (const Index v : vertices) mover_[v] = kFixed;
}

void HeightFit::add_face(Index triangle) {
  if (met_[triangle] == call_) return;
  met_[triangle] = call_;
  if (!surface_.is_covered(triangle)) return;
  const Index* const corner = surface_.mesh().origin + first_edge(triangle);
  Face face{};
  face.begin = posts_;
  add_posts({surface_.vertex(corner[0]), surface_.vertex(corner[1]), surface_.vertex(corner[2])});
  face.end = posts_;
  face.excess = excess_of(face, weight_[0].data(), 0);
  for (uint32_t i = 0; i < 3; ++i) {
    face.mover[i] = mover_[corner[i]];
    if (face.mover[i] == kFixed) continue;
    movers_[face.mover[i]].corners.emplace_back(static_cast<uint32_t>(faces_.size()), i);
  }
  faces_.push_back(face);
  triangles_.push_back(triangle);
}

void HeightFit::add_posts(const std::array<Vertex, 3>& corner) {
  const auto& [va, vb, vc] = corner;
  const Point a{va.x, va.y}, b{vb.x, vb.y}, c{vc.x, vc.y};
  // The weights of b and c grow evenly along x and y.
  const float scale = 1.0F / static_cast<float>(orient2d(a, b, c));
  const float b_along_x = static_cast<float>(c.y - a.y) * scale;
  const float b_along_y = static_cast<float>(a.x - c.x) * scale;
  const float c_along_x = static_cast<float>(a.y - b.y) * scale;
  const float c_along_y = static_cast<float>(b.x - a.x) * scale;
  const int32_t base = va.z;
  const auto b_rise = static_cast<float>(vb.z - va.z), c_rise = static_cast<float>(vc.z - va.z);
  surface_.posts().visit_under(a, b, c, [&](uint32_t s, Point p) {
    const std::size_t i = posts_++;
    reserve(posts_);
    const auto x = static_cast<float>(p.x - a.x), y = static_cast<float>(p.y - a.y);
    const float to_b = b_along_x * x + b_along_y * y, to_c = c_along_x * x + c_along_y * y;
    const Surface::Target& target = surface_.target(s);
    sample_[i] = s;
    error_[i] = static_cast<float>(base - target.middle) + to_b * b_rise + to_c * c_rise;
    radius_[i] = target.radius;
    weight_[0][i] = 1.0F - to_b - to_c;
    weight_[1][i] = to_b;
    weight_[2][i] = to_c;
  });
  for (; posts_ % kLanes != 0; ++posts_) {  // posts that nothing moves
    reserve(posts_ + 1);
    error_[posts_] = radius_[posts_] = 0;
    for (std::vector<float>& weight : weight_) weight[posts_] = 0;
  }
}

void HeightFit::reserve(std::size_t posts) {
  if (posts <= error_.size()) return;
  const std::size_t size = 2 * posts + kLanes;
  sample_.resize(size);
  error_.resize(size);
  radius_.resize(size);
  for (std::vector<float>& weight : weight_) weight.resize(size);
}

// The sum of squared distances from the bounds if a corner with these weights moved.
float HeightFit::excess_of(const Face& face, const float* weight, float shift) const {
  Lanes sum{};
  const Lanes none{};
  for (std::size_t i = face.begin; i < face.end; i += kLanes) {
    const Lanes error = load(error_.data() + i) + shift * load(weight + i);
    const Lanes over = (error < 0 ? -error : error) - load(radius_.data() + i);
    const Lanes excess = over < 0 ? none : over;
    sum += excess * excess;
  }
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

void HeightFit::evaluate(Face& face) const {
  const auto stride = static_cast<float>(stride_);
  face.excess = excess_of(face, weight_[0].data(), 0);
  for (uint32_t i = 0; i < 3; ++i) {
    if (face.mover[i] == kFixed) continue;
    face.shifted[i][0] = excess_of(face, weight_[i].data(), -stride);
    face.shifted[i][1] = excess_of(face, weight_[i].data(), stride);
  }
}

double HeightFit::excess() const {
  double sum = 0;
  for (const Face& face : faces_) sum += face.excess;
  return sum;
}

// The shift is 0 if none helps.
HeightFit::Step HeightFit::best_step() const {
  Step best{0, 0};
  double lowest = -kNegligible;
  for (std::size_t m = 0; m < mover_count_; ++m) {
    double change[2] = {0, 0};
    for (const auto& [f, corner] : movers_[m].corners) {
      change[0] += faces_[f].shifted[corner][0] - faces_[f].excess;
      change[1] += faces_[f].shifted[corner][1] - faces_[f].excess;
    }
    for (const int up : {0, 1}) {
      if (change[up] >= lowest) continue;
      lowest = change[up];
      best = {m, up != 0 ? stride_ : -stride_};
    }
  }
  return best;
}

void HeightFit::take(Step step) {
  Mover& mover = movers_[step.mover];
  mover.shift += step.shift;
  const auto shift = static_cast<float>(step.shift);
  for (const auto& [f, corner] : mover.corners) {
    Face& face = faces_[f];
    const float* const weight = weight_[corner].data();
    for (std::size_t i = face.begin; i < face.end; ++i) error_[i] += shift * weight[i];
    evaluate(face);
  }
}

uint32_t HeightFit::worst_sample(std::size_t rank) const {
  std::vector<std::pair<float, uint32_t>> worst;  // how far out, which sample
  for (const Face& face : faces_) {
    if (face.excess == 0) continue;
    worst.emplace_back(0.0F, 0);
    for (std::size_t i = face.begin; i < face.end; ++i) {
      const float over = std::abs(error_[i]) - radius_[i];
      if (over > worst.back().first) worst.back() = {over, sample_[i]};
    }
  }
  std::sort(worst.rbegin(), worst.rend());
  return worst.empty() ? 0 : worst[std::min(rank, worst.size() - 1)].second;
}

}  // namespace microtin::fit
