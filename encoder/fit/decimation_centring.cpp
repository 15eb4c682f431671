// SPDX-License-Identifier: MIT
// The part of Decimation that brings the mean error nearer zero.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "encoder/fit/decimation.hpp"

namespace microtin::fit {
namespace {

// The part of all triangles that may get a vertex: a vertex of large ones moves more posts.
constexpr std::size_t kLargePart = 4;

}  // namespace

void Decimation::aim(double mean) {
  rise_ = std::llround(-3 * mean * static_cast<double>(surface_.covered_area()));
}

void Decimation::centre(int near, const Progress& progress) {
  preferred_ = direction();
  forget();
  const auto move = [&](Attempts& attempts, Index v) {
    return !has_reached_mean() && attempts.move_and_gain(v, near);
  };
  try_each(progress, move, [this](const Outcome& outcome) {
    const bool is_wanted = !has_reached_mean();
    if (is_wanted) rise_ -= outcome.raised;
    return is_wanted;
  });
  preferred_ = 0;
  forget();
}

void Decimation::add_vertices(std::size_t most) {
  most = std::min<std::size_t>(most, surface_.vertex_limit() - surface_.vertices());
  if (most == 0) return;
  preferred_ = direction();
  Attempts& attempts = workers_.front().attempts;
  for (const Attempts::Addition& addition : additions()) {
    if (most == 0 || has_reached_mean()) break;
    attempts.begin(0);
    if (!attempts.add(addition)) continue;
    rise_ -= attempts.outcome(false).raised;
    attempts.keep();
    --most;
  }
  preferred_ = 0;
  forget();
}

// The best first.
std::vector<Attempts::Addition> Decimation::additions() {
  const std::vector<std::array<Index, 3>> triangles = large_triangles();
  begin_pass();
  std::vector<std::optional<Attempts::Addition>> found(triangles.size());
  team_.for_each(triangles.size(), [&](std::size_t i, std::size_t worker) {
    Attempts& attempts = workers_[worker].attempts;
    attempts.begin(0);
    found[i] = attempts.addition_in(triangles[i]);
  });
  end_pass();
  std::vector<Attempts::Addition> additions;
  for (const std::optional<Attempts::Addition>& addition : found) {
    if (addition && addition->gain > 0) additions.push_back(*addition);
  }
  std::stable_sort(additions.begin(), additions.end(),
                   [](const auto& a, const auto& b) { return a.gain > b.gain; });
  return additions;
}

// By their corners, near which a vertex is added.
std::vector<std::array<Index, 3>> Decimation::large_triangles() const {
  std::vector<std::pair<int64_t, std::array<Index, 3>>> triangles;
  surface_.visit_covered([&](Index t) {
    const Index* const corner = surface_.mesh().origin + first_edge(t);
    const int64_t area =
        orient2d(surface_.place(corner[0]), surface_.place(corner[1]), surface_.place(corner[2]));
    triangles.push_back({-area, {corner[0], corner[1], corner[2]}});
  });
  std::sort(triangles.begin(), triangles.end());
  triangles.resize(triangles.size() / kLargePart);
  std::vector<std::array<Index, 3>> large;
  large.reserve(triangles.size());
  for (const auto& triangle : triangles) large.push_back(triangle.second);
  return large;
}

}  // namespace microtin::fit
