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
constexpr float kHopeless = 1.2F;     // radii beyond a bound: 1 in 500 fits began worse, as counted
constexpr double kNegligible = 1e-8;  // excess, in squared steps

// Several numbers at once.
constexpr std::size_t kLanes = 4;
static_assert(kLanes <= PostIndex::kReadAhead, "runs are read beyond their ends");
typedef float Lanes __attribute__((vector_size(kLanes * sizeof(float))));

Lanes load(const float* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

void store(Lanes lanes, float* to) {
  std::memcpy(to, &lanes, sizeof lanes);
}

Lanes height_above(int16_t z, const double* middles) {
  Lanes above{};
  for (std::size_t i = 0; i < kLanes; ++i) above[i] = static_cast<float>(z - middles[i]);
  return above;
}

// How far each is beyond its radius, squared.
Lanes squared_excess(Lanes error, Lanes radius) {
  const Lanes over = (error < 0 ? -error : error) - radius;
  const Lanes excess = over < 0 ? Lanes{} : over;
  return excess * excess;
}

float sum_of(Lanes lanes) {
  return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

}  // namespace

HeightFit::HeightFit(const Surface& surface)
    : surface_(surface), mover_(surface.vertex_limit(), kFixed), met_(surface.mesh().triangles) {}

bool HeightFit::fit(const std::vector<Index>& vertices, const std::vector<Index>& fresh) {
  begin(vertices);
  for (const Index t : fresh) add_face(t);
  bool fits = !is_hopeless() && descend();
  if (fits) {
    begin(vertices);
    for (const Index v : vertices) {
      surface_.visit_around(v, [this](Index h) { add_face(triangle_of(h)); });
    }
    fits = descend();
  }
  for (const Index v : vertices) mover_[v] = kFixed;
  if (fits) settle();
  return fits;
}

// Brings heights nearer to the source, or where they are preferred, one step each, where no excess
// comes of it.
void HeightFit::settle() {
  for (std::size_t m = 0; m < mover_count_; ++m) {
    const int32_t shift = preferred_ != 0 ? preferred_ : step_to_source(movers_[m]);
    const auto stays = [&](const std::pair<uint32_t, uint32_t>& at) {
      const Face& face = faces_[at.first];
      return excess_of(face, at.second, static_cast<float>(shift))[1] <= face.excess;
    };
    const auto& corners = movers_[m].corners;
    if (shift != 0 && std::all_of(corners.begin(), corners.end(), stays)) move(movers_[m], shift);
  }
}

// Which step of a height, if any, lowers the sum of squared errors.
int32_t HeightFit::step_to_source(const Mover& mover) const {
  Lanes slopes{}, bends{};
  for (const auto& [f, corner] : mover.corners) {
    const float* const weight = weight_[corner].data();
    for (std::size_t i = faces_[f].begin; i < faces_[f].end; i += kLanes) {
      const Lanes w = load(weight + i);
      slopes += w * load(error_.data() + i);
      bends += w * w;
    }
  }
  const float slope = sum_of(slopes), bend = sum_of(bends);
  if (2 * std::abs(slope) <= bend) return 0;
  return slope > 0 ? -1 : 1;
}

// Whether a post is so far out that heights around will not mend it.
bool HeightFit::is_hopeless() const {
  for (const Face& face : faces_) {
    if (face.excess == 0) continue;
    for (std::size_t i = face.begin; i < face.end; ++i) {
      const float over = std::abs(error_[i]) - radius_[i];
      if (over > kHopeless * std::max(radius_[i], 1.0F)) return true;
    }
  }
  return false;
}

bool HeightFit::descend() {
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

void HeightFit::begin(const std::vector<Index>& vertices) {
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
  face.excess = excess_of(face);
  for (uint32_t i = 0; i < 3; ++i) {
    face.mover[i] = mover_[corner[i]];
    if (face.mover[i] == kFixed) continue;
    movers_[face.mover[i]].corners.emplace_back(static_cast<uint32_t>(faces_.size()), i);
  }
  faces_.push_back(face);
  triangles_.push_back(triangle);
}

void HeightFit::add_posts(const std::array<Vertex, 3>& corner) {
  const Vertex &va = corner[0], &vb = corner[1], &vc = corner[2];
  const Point a{va.x, va.y}, b{vb.x, vb.y}, c{vc.x, vc.y};
  // The weights of b and c grow evenly along x and y.
  const float scale = 1.0F / static_cast<float>(orient2d(a, b, c));
  const float b_along_x = static_cast<float>(c.y - a.y) * scale;
  const float b_along_y = static_cast<float>(a.x - c.x) * scale;
  const float c_along_x = static_cast<float>(a.y - b.y) * scale;
  const float c_along_y = static_cast<float>(b.x - a.x) * scale;
  const auto b_rise = static_cast<float>(vb.z - va.z), c_rise = static_cast<float>(vc.z - va.z);
  const PostIndex& posts = surface_.posts();
  posts.visit_runs(a, b, c, [&](std::size_t first, std::size_t last) {
    reserve(posts_ + (last - first));
    const auto x = static_cast<float>(posts.place(first).x - a.x);
    const float b_before = b_along_x * x, c_before = c_along_x * x;
    for (std::size_t i = first; i < last; i += kLanes) {
      const Lanes y = load(posts.rows() + i) - static_cast<float>(a.y);
      const Lanes to_b = b_before + b_along_y * y, to_c = c_before + c_along_y * y;
      const std::size_t to = posts_ + (i - first);
      const Lanes above = height_above(va.z, surface_.middles() + i);
      store(above + to_b * b_rise + to_c * c_rise, error_.data() + to);
      store(load(surface_.radii() + i), radius_.data() + to);
      store(1.0F - to_b - to_c, weight_[0].data() + to);
      store(to_b, weight_[1].data() + to);
      store(to_c, weight_[2].data() + to);
    }
    for (std::size_t i = first; i < last; ++i) position_[posts_++] = static_cast<uint32_t>(i);
  });
  for (; posts_ % kLanes != 0; ++posts_) {  // posts that nothing moves
    reserve(posts_ + 1);
    error_[posts_] = radius_[posts_] = 0;
    for (std::vector<float>& weight : weight_) weight[posts_] = 0;
  }
}

void HeightFit::reserve(std::size_t posts) {
  if (posts + kLanes <= error_.size()) return;
  const std::size_t size = 2 * posts + kLanes;
  position_.resize(size);
  error_.resize(size);
  radius_.resize(size);
  for (std::vector<float>& weight : weight_) weight.resize(size);
}

// The sum of squared distances from the bounds.
float HeightFit::excess_of(const Face& face) const {
  Lanes sum{};
  for (std::size_t i = face.begin; i < face.end; i += kLanes) {
    sum += squared_excess(load(error_.data() + i), load(radius_.data() + i));
  }
  return sum_of(sum);
}

// The same if a corner moved down, and up.
std::array<float, 2> HeightFit::excess_of(const Face& face, uint32_t corner, float shift) const {
  Lanes down{}, up{};
  for (std::size_t i = face.begin; i < face.end; i += kLanes) {
    const Lanes error = load(error_.data() + i), radius = load(radius_.data() + i);
    const Lanes change = shift * load(weight_[corner].data() + i);
    down += squared_excess(error - change, radius);
    up += squared_excess(error + change, radius);
  }
  return {sum_of(down), sum_of(up)};
}

void HeightFit::evaluate(Face& face) const {
  face.excess = excess_of(face);
  for (uint32_t i = 0; i < 3; ++i) {
    if (face.mover[i] == kFixed) continue;
    face.shifted[i] = excess_of(face, i, static_cast<float>(stride_));
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
  move(movers_[step.mover], step.shift);
  for (const auto& [f, corner] : movers_[step.mover].corners) evaluate(faces_[f]);
}

void HeightFit::move(Mover& mover, int32_t shift) {
  mover.shift += shift;
  const auto steps = static_cast<float>(shift);
  for (const auto& [f, corner] : mover.corners) {
    float* const error = error_.data();
    const float* const weight = weight_[corner].data();
    for (std::size_t i = faces_[f].begin; i < faces_[f].end; i += kLanes) {
      store(load(error + i) + steps * load(weight + i), error + i);
    }
  }
}

uint32_t HeightFit::worst_sample(std::size_t rank) const {
  std::vector<std::pair<float, uint32_t>> worst;  // how far out, which sample
  for (const Face& face : faces_) {
    if (face.excess == 0) continue;
    worst.emplace_back(0.0F, 0);
    for (std::size_t i = face.begin; i < face.end; ++i) {
      const float over = std::abs(error_[i]) - radius_[i];
      if (over > worst.back().first) worst.back() = {over, position_[i]};
    }
  }
  std::sort(worst.rbegin(), worst.rend());
  const PostIndex& posts = surface_.posts();
  return posts.number(worst.empty() ? 0 : worst[std::min(rank, worst.size() - 1)].second);
}

}  // namespace microtin::fit
