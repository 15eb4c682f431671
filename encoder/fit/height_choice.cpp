// SPDX-License-Identifier: MIT
// Takes the cheapest height of each vertex in turn, by lengths of codes learned from all.
#include "encoder/fit/height_choice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

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

}  // namespace

HeightChoice::HeightChoice(Surface& surface, uint32_t degree) : surface_(surface) {
  find_rings(degree);
  find_dependents();
  for (const Index v : vertex_) z_.push_back(surface_.height(v));
  residual_.resize(vertex_.size());
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

// What vertex i and those that it predicts take at a height.
float HeightChoice::cost_at(Index i, int32_t height) {
  z_[i] = static_cast<int16_t>(height);
  float sum = cost(i);
  for (uint32_t k = dependent_start_[i]; k < dependent_start_[i + 1]; ++k) {
    sum += cost(dependents_[k]);
  }
  return sum;
}

void HeightChoice::choose(Index i) {
  const Index v = vertex_[i];
  const Surface::Interval allowed = surface_.allowed_heights(v);
  const int32_t before = z_[i], predicted = predict(i).height;
  const int32_t around =
      std::clamp(predicted, std::min(allowed.low, before), std::max(allowed.high, before));
  const auto error = [&](int32_t z) { return std::abs(z - allowed.best); };
  float lowest = cost_at(i, before);
  int32_t best = before;
  for (int32_t z = std::max(allowed.low, around - kReach);
       z <= std::min(allowed.high, around + kReach); ++z) {
    const float cost = cost_at(i, z);
    if (cost > lowest || (cost == lowest && error(z) >= error(best))) continue;
    surface_.set_height(v, static_cast<int16_t>(z));
    if (!surface_.keeps_bounds_around(v)) continue;
    lowest = cost;
    best = z;
  }
  z_[i] = static_cast<int16_t>(best);
  surface_.set_height(v, z_[i]);
  residual_[i] = residual_of(best - predict(i).height);
}

void HeightChoice::pass() {
  learn_costs();
  for (Index i = 0; i < z_.size(); ++i) choose(i);
}

}  // namespace microtin::fit
