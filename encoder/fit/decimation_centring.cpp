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

// Posts that a vertex tries.
constexpr std::size_t kTries = 24;

// The part of all triangles that may get a vertex: a vertex of large ones moves more posts.
constexpr std::size_t kLargePart = 4;

// How many steps from its triangle an added vertex may be.
constexpr int kFarthestMove = 2;

uint16_t even(int coordinate) {
  return static_cast<uint16_t>(coordinate - coordinate % 2);
}

int16_t height(int32_t z) {
  return static_cast<int16_t>(std::clamp(z, -32768, 32767));
}

}  // namespace

void Decimation::aim(double mean) {
  rise_ = std::llround(-3 * mean * static_cast<double>(surface_.covered_area()));
}

void Decimation::centre(int near, const Progress& progress) {
  const int32_t direction_at_first = direction();
  fit_.prefer(direction_at_first);
  forget();
  try_each(progress,
           [&](Index v) { return direction_at_first * rise_ > 0 && try_towards_centre(v, near); });
  fit_.prefer(0);
  forget();
}

// Says whether there is a vertex less.
bool Decimation::try_towards_centre(Index v, int near) {
  const Vertex old = surface_.vertex(v);
  const std::optional<Hole> hole = remove(v);
  if (!hole) return false;
  const bool removed = fit(hole->ring) && gain() >= 0;
  if (!removed) {
    edits_.roll_back(1);
    if (!move_near(old, near, *hole)) {
      edits_.roll_back(0);
      return false;
    }
  }
  rise_ -= raised_;
  return removed;
}

// Moves a vertex that was removed to a post near its own, or back there with other heights around,
// so that the mean error comes nearer zero: to the one that brings it nearest before heights are
// fitted, of those that are tried and keep their bounds. Says whether there is one.
bool Decimation::move_near(Vertex old, int near, const Hole& hole) {
  std::vector<std::pair<int64_t, Vertex>> posts;  // and what they gain
  for (int x = old.x - near; x <= old.x + near; ++x) {
    const int rest = near - std::abs(x - old.x);
    for (int y = old.y - rest; y <= old.y + rest; ++y) {
      std::optional<Vertex> to = carried(old, x, y);
      if (!to || to->x % 2 + to->y % 2 > old.x % 2 + old.y % 2) continue;
      to->z = height(to->z + direction());
      if (!place(*to, hole)) continue;
      posts.emplace_back(gain(), *to);
      edits_.roll_back(1);
    }
  }
  std::stable_sort(posts.begin(), posts.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  const std::size_t tries = std::min(posts.size(), kTries);
  for (std::size_t i = 0; i < tries; ++i) {
    if (!insert(posts[i * posts.size() / tries].second, hole)) continue;
    if (gain() > 0) return true;
    edits_.roll_back(1);
  }
  return false;
}

void Decimation::add_vertices(std::size_t most) {
  const int32_t direction_at_first = direction();
  most = std::min<std::size_t>(most, surface_.vertex_limit() - surface_.vertices());
  if (most == 0) return;
  fit_.prefer(direction_at_first);
  for (const Addition& addition : additions()) {
    if (most == 0 || direction_at_first * rise_ <= 0) break;
    if (add(addition)) --most;
  }
  fit_.prefer(0);
  forget();
}

// The best first.
std::vector<Decimation::Addition> Decimation::additions() {
  std::vector<Addition> additions;
  for (const std::array<Index, 3>& corners : large_triangles()) {
    const std::optional<Addition> addition = addition_in(corners);
    if (addition && addition->gain > 0) additions.push_back(*addition);
    fitted_.clear();
  }
  std::stable_sort(additions.begin(), additions.end(),
                   [](const Addition& a, const Addition& b) { return a.gain > b.gain; });
  return additions;
}

// By their corners, since an attempt that is taken back may renumber triangles.
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

// A vertex at a cheap post near the middle of a triangle, as far from its middle height as fits.
std::optional<Decimation::Addition> Decimation::addition_in(const std::array<Index, 3>& corners) {
  int x = 0, y = 0, z = 0;
  for (const Index corner : corners) {
    const Vertex vertex = surface_.vertex(corner);
    x += vertex.x;
    y += vertex.y;
    z += vertex.z;
  }
  const Point to{even(x / 3), even(y / 3)};
  if (!surface_.posts().find(to)) return std::nullopt;
  for (int steps = kFarthestMove; steps > 0; --steps) {
    const Vertex vertex{to.x, to.y, height(z / 3 + direction() * steps)};
    if (!insert(vertex, Hole{{corners[0], corners[1], corners[2]}, 0})) continue;
    const int64_t gained = gain();
    edits_.roll_back(0);
    return Addition{gained, vertex, corners[0]};
  }
  return std::nullopt;
}

// Adds a vertex if that still gains half as much. Says whether it did.
bool Decimation::add(const Addition& addition) {
  if (!insert(addition.vertex, Hole{{addition.corner}, 0})) return false;
  if (2 * gain() < addition.gain) {
    edits_.roll_back(0);
    fitted_.clear();
    return false;
  }
  rise_ -= raised_;
  keep_edits();
  return true;
}

}  // namespace microtin::fit
