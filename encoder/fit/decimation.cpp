// SPDX-License-Identifier: MIT
// Removes and moves vertices one by one, and takes back what breaks a bound.
#include "encoder/fit/decimation.hpp"

#include <algorithm>

namespace microtin::fit {
namespace {

bool contains(const std::vector<Index>& vertices, Index v) {
  return std::find(vertices.begin(), vertices.end(), v) != vertices.end();
}

// A vertex may go where the bound is missed most, or second or third most: always to go to the
// worst place ends the search early.
constexpr std::size_t kRanks = 3;

}  // namespace

Decimation::Decimation(Surface& surface)
    : surface_(surface), edits_(surface), fit_(surface), stale_(surface.vertex_limit()) {}

std::size_t Decimation::remove_vertices(const Progress& progress) {
  const std::size_t removed = try_each(progress, [this](Index v) { return try_removal(v); });
  forget();  // what could not be removed has not been moved yet
  return removed;
}

std::size_t Decimation::remove_and_move_vertices(const Progress& progress) {
  return try_each(progress, [this](Index v) { return try_move(v); });
}

template <class Try>
std::size_t Decimation::try_each(const Progress& progress, const Try& attempt) {
  std::vector<Index> order;
  for (Index v = 0; v < surface_.vertex_limit(); ++v) {
    if (surface_.has_vertex(v) && !surface_.is_fixed(v) && !stale_[v]) order.push_back(v);
  }
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random_below(i)]);
  std::size_t removed = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Index v = order[i];
    if (i % 256 == 0) progress.at(static_cast<double>(i) / static_cast<double>(order.size()));
    if (!surface_.has_vertex(v)) continue;
    stale_[v] = true;
    fitted_.clear();
    if (attempt(v)) ++removed;
    if (edits_.size() != 0) note_changes();
    edits_.commit();
  }
  return removed;
}

// Knuth's linear congruential generator.
std::size_t Decimation::random_below(std::size_t limit) {
  random_ = random_ * 6364136223846793005u + 1442695040888963407u;
  return (random_ >> 33) % limit;
}

// What lies near a change may be tried again.
void Decimation::note_changes() {
  for (const Index v : fitted_) {
    if (!surface_.has_vertex(v)) continue;
    stale_[v] = false;
    for (const Index neighbour : ring(v)) stale_[neighbour] = false;
  }
}

std::vector<Index> Decimation::ring(Index v) const {
  std::vector<Index> ring;
  surface_.visit_around(v, [&](Index h) {
    const Index neighbour = surface_.mesh().origin[next_in_triangle(h)];
    if (neighbour != kInfinity) ring.push_back(neighbour);
  });
  return ring;
}

// Moves vertices up and down until all around is within bounds, and says whether it is.
bool Decimation::fit(const std::vector<Index>& vertices) {
  const bool fits = fit_.fit(vertices);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (fit_.shift(i) == 0) continue;
    if (!edits_.set_height(vertices[i], surface_.height(vertices[i]) + fit_.shift(i))) return false;
  }
  if (!fits || !std::all_of(fit_.triangles().begin(), fit_.triangles().end(),
                            [this](Index t) { return surface_.keeps_bounds(t); })) {
    return false;
  }
  fitted_.insert(fitted_.end(), vertices.begin(), vertices.end());
  return true;
}

bool Decimation::try_removal(Index v) {
  const std::size_t before = edits_.size();
  const std::vector<Index> neighbours = ring(v);
  if (!edits_.remove(v)) return false;
  if (fit(neighbours)) return true;
  edits_.roll_back(before);
  return false;
}

// Says whether there is a vertex less.
bool Decimation::try_move(Index v) {
  std::vector<Index> vertices = ring(v);
  const Vertex old = surface_.vertex(v);
  if (!edits_.remove(v)) return false;
  if (fit(vertices)) return true;
  const Sample& worst = surface_.survey().samples[fit_.worst_sample(random_below(kRanks))];
  const Index hint = surface_.edge_of(vertices[0]);
  if (worst.place == Point{old.x, old.y} || !surface_.can_insert(worst.place, hint)) {
    edits_.roll_back(0);
    return false;
  }
  const int16_t height = surface_.model().vertex_height(worst);
  const Index moved = edits_.insert({worst.place.x, worst.place.y, height}, hint);
  const std::vector<Index> neighbours = ring(moved);
  for (const Index r : neighbours) {
    if (!contains(vertices, r)) vertices.push_back(r);
  }
  vertices.push_back(moved);
  if (!fit(vertices)) {
    edits_.roll_back(0);
    return false;
  }
  return std::any_of(neighbours.begin(), neighbours.end(),
                     [this](Index r) { return !surface_.is_fixed(r) && try_removal(r); });
}

}  // namespace microtin::fit
