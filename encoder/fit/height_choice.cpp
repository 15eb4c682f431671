// SPDX-License-Identifier: MIT
// Takes the cheapest height of each vertex in turn, by lengths of codes learned from all.
#include "encoder/fit/height_choice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include "encoder/stream/order.hpp"

namespace microtin::fit {
namespace {

uint32_t bits_of(int32_t difference) {
  const auto magnitude = static_cast<uint32_t>(std::abs(difference));
  return magnitude == 0 ? 0 : highest_bit(magnitude) + 1;
}

// By a pointer: clang's analyzer does not see that the weights of a ring are never all 0.
auto* predict_from_ring = predict_height;

constexpr int32_t kReach = 4;  // steps from the prediction that are looked at

// Bits that a vertex may cost more for the sake of small errors: this many if its posts then are at
// their heights instead of at their bounds.
constexpr double kCloseness = 4, kFlatness = 30;

}  // namespace

HeightChoice::HeightChoice(Surface& surface, Team& team, uint32_t degree, double weight)
    : surface_(surface),
      team_(team),
      balance_(surface, weight),
      radius_(surface.mean_radius()),
      allowed_(surface.vertex_limit()) {
  find_rings(degree);
  find_dependents();
  z_.reserve(vertex_.size());
  for (const Index v : vertex_) z_.push_back(surface_.height(v));
  residual_.resize(vertex_.size());
  find_levels();
  const auto posts = static_cast<double>(std::max<std::size_t>(surface.bounded_posts(), 1));
  vertices_per_radius_ = static_cast<double>(vertex_.size()) / (posts * radius_ * radius_);
  mesh_ = Mesh{place_.data(), z_.data(), nullptr, nullptr, static_cast<Index>(place_.size()), 0};
}

void HeightChoice::find_rings(uint32_t degree) {
  std::vector<Index> live;
  std::vector<Point> places;
  for (Index v = 0; v < surface_.vertex_limit(); ++v) {
    if (!surface_.has_vertex(v)) continue;
    live.push_back(v);
    places.push_back(surface_.place(v));
  }
  vertex_.reserve(live.size());
  place_.reserve(live.size());
  ring_start_.reserve(live.size() + 1);
  Triangulation all(places);
  const Order order = breadth_first_order(all, degree);
  const auto send = [&](Index i) {
    vertex_.push_back(live[i]);
    place_.push_back(places[i]);
    ring_start_.push_back(static_cast<uint32_t>(rings_.size()));
  };
  for (const Index i : order.seed) send(i);
  Triangulation sent({places[order.seed[0]], places[order.seed[1]], places[order.seed[2]]});
  for (const std::vector<Index>& batch : order.batches) {
    Index hint = 0;
    for (const Index i : batch) {
      send(i);
      hint = sent.edge_of(sent.insert(places[i], hint));
      for (const Index t : sent.new_triangles()) {
        const Index neighbour = sent.mesh().origin[first_edge(t)];
        if (neighbour != kInfinity) rings_.push_back(neighbour);
      }
    }
  }
  ring_start_.push_back(static_cast<uint32_t>(rings_.size()));
  rings_.shrink_to_fit();
}

void HeightChoice::find_dependents() {
  dependent_start_.assign(vertex_.size() + 1, 0);
  for (const Index i : rings_) ++dependent_start_[i + 1];
  for (std::size_t i = 1; i < dependent_start_.size(); ++i) {
    dependent_start_[i] += dependent_start_[i - 1];
  }
  dependents_.resize(dependent_start_.back());
  std::vector<uint32_t> next(dependent_start_);
  for (Index i = 0; i < vertex_.size(); ++i) {
    for (uint32_t k = ring_start_[i]; k < ring_start_[i + 1]; ++k) {
      dependents_[next[rings_[k]]++] = i;
    }
  }
}

// Nothing predicts the first three: they cost the same at any height.
HeightPrediction HeightChoice::predict(Index i) const {
  const Index* const ring = rings_.data() + ring_start_[i];
  const uint32_t size = ring_start_[i + 1] - ring_start_[i];
  if (size == 0) return {z_[i], 0, 0};
  return predict_from_ring(mesh_, residual_.data(), ring, size, point_of(mesh_, i));
}

// Takes the lengths of codes from how often which numbers of bits occur now.
void HeightChoice::learn_costs() {
  for (auto& scale : bits_) scale.fill(0.2F);
  for (Index i = 0; i < z_.size(); ++i) {
    const HeightPrediction prediction = predict(i);
    residual_[i] = residual_of(z_[i] - prediction.height);
    bits_[prediction.scale][bits_of(z_[i] - prediction.height)] += 1;
  }
  for (auto& scale : bits_) {
    float sum = 0;
    for (const float count : scale) sum += count;
    for (uint32_t b = 0; b < scale.size(); ++b) {
      scale[b] = std::log2(sum / scale[b]) + static_cast<float>(b);  // the sign and what follows
    }
  }
}

float HeightChoice::cost(Index i) const {
  const HeightPrediction prediction = predict(i);
  return bits_[prediction.scale][bits_of(z_[i] - prediction.height)];
}

// What vertex i and those that it predicts take at a height, if that is below `most`; else a part
// of it that is not.
float HeightChoice::cost_at(Index i, int32_t height, float most) {
  z_[i] = static_cast<int16_t>(height);
  float sum = cost(i);
  for (uint32_t k = dependent_start_[i]; k < dependent_start_[i + 1] && sum < most; ++k) {
    sum += cost(dependents_[k]);
  }
  return sum;
}

// What the errors of a height are worth, in bits.
float HeightChoice::price(const Goal& goal, int32_t height) {
  const double off = height - goal.height;
  return static_cast<float>(goal.weight * off * off);
}

HeightChoice::Goal HeightChoice::goal_of(Index i, const Surface::Interval& allowed) const {
  if (level_[i]) return {*level_[i], kFlatness / (radius_ * radius_)};
  return {allowed.best, kCloseness * allowed.curvature * vertices_per_radius_};
}

void HeightChoice::choose(Index i) {
  const Surface::Interval allowed = allowed_heights(vertex_[i]);
  const int32_t before = z_[i];
  const bool is_free = allowed.low < before || allowed.high > before;
  const int32_t best = is_free ? cheapest(i, allowed) : before;
  if (best != before) set_height(i, best);
  residual_[i] = residual_of(best - predict(i).height);
}

// The allowed height of vertex i that takes the fewest bits; the one that it has if none is better.
int32_t HeightChoice::cheapest(Index i, const Surface::Interval& allowed) {
  const Index v = vertex_[i];
  const Goal goal = goal_of(i, allowed);
  const int32_t before = z_[i], predicted = predict(i).height;
  const int32_t around =
      std::clamp(predicted, std::min(allowed.low, before), std::max(allowed.high, before));
  float lowest = cost_at(i, before, std::numeric_limits<float>::max()) + price(goal, before);
  int32_t best = before;
  const auto consider = [&](int32_t z) {
    if (z == before) return;
    const float errors = price(goal, z) + static_cast<float>(balance_.price(v, z - before));
    const float cost = cost_at(i, z, lowest - errors) + errors;
    if (cost >= lowest) return;
    surface_.set_height(v, static_cast<int16_t>(z));
    if (!surface_.keeps_bounds_around(v)) return;
    lowest = cost;
    best = z;
  };
  const int32_t low = std::max(allowed.low, around - kReach);
  const int32_t high = std::min(allowed.high, around + kReach);
  for (int32_t z = low; z <= high; ++z) consider(z);
  const auto aim = static_cast<int32_t>(std::lround(std::clamp(goal.height, -32768.0, 32767.0)));
  if ((aim < low || aim > high) && aim >= allowed.low && aim <= allowed.high) consider(aim);
  z_[i] = static_cast<int16_t>(before);
  surface_.set_height(v, z_[i]);
  return best;
}

void HeightChoice::set_height(Index i, int32_t height) {
  const Index v = vertex_[i];
  balance_.move(v, height - z_[i]);
  z_[i] = static_cast<int16_t>(height);
  surface_.set_height(v, z_[i]);
  surface_.visit_around(v, [this](Index h) {
    const Index neighbour = surface_.mesh().origin[next_in_triangle(h)];
    if (neighbour != kInfinity) allowed_[neighbour].reset();
  });
}

// Finds those that are not known, so that only those that change on the way are left.
void HeightChoice::find_allowed_heights() {
  constexpr std::size_t kAtOnce = 64;
  team_.for_each((vertex_.size() + kAtOnce - 1) / kAtOnce, [this](std::size_t part, std::size_t) {
    const std::size_t end = std::min(vertex_.size(), (part + 1) * kAtOnce);
    for (std::size_t i = part * kAtOnce; i < end; ++i) allowed_heights(vertex_[i]);
  });
}

// They depend on the heights of its neighbours alone.
const Surface::Interval& HeightChoice::allowed_heights(Index v) {
  if (!allowed_[v]) allowed_[v] = surface_.allowed_heights(v);
  return *allowed_[v];
}

// Vertices surrounded by posts of one height.
void HeightChoice::find_levels() {
  const PostIndex& posts = surface_.posts();
  const auto height = [&](int x, int y) -> std::optional<int32_t> {
    if (x < 0 || y < 0 || x > kLatticeMax || y > kLatticeMax) return std::nullopt;
    const auto post = posts.find({static_cast<uint16_t>(x), static_cast<uint16_t>(y)});
    if (!post) return std::nullopt;
    return surface_.survey().samples[posts.number(*post)].height;
  };
  level_.reserve(place_.size());
  for (const Point p : place_) {
    const auto here = height(p.x, p.y);
    const auto as_here = [&](int dx, int dy) { return height(p.x + dx, p.y + dy) == here; };
    const bool flat = as_here(1, 0) && as_here(-1, 0) && as_here(0, 1) && as_here(0, -1);
    level_.push_back(here && flat ? std::optional<double>(*here / 65536.0) : std::nullopt);
  }
}

void HeightChoice::pass() {
  learn_costs();
  find_allowed_heights();
  for (Index i = 0; i < z_.size(); ++i) choose(i);
}

void HeightChoice::balance() {
  balance_.weigh_more();
  pass();
}

}  // namespace microtin::fit
