// SPDX-License-Identifier: MIT
// Removes, moves and adds single vertices, and takes back what breaks a bound.
#include "encoder/fit/attempts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace microtin::fit {
namespace {

bool contains(const std::vector<Index>& vertices, Index v) {
  return std::find(vertices.begin(), vertices.end(), v) != vertices.end();
}

// A vertex may go where the bound is missed most, or second or third most: always to go to the
// worst place ends the search early.
constexpr std::size_t kRanks = 3;

// Before that a vertex tries kNearTries posts near its own, at random: each at most kNearest or
// kFarther steps away along x and y. Such moves are kept more often than those to the worst place,
// and after them other vertices may go.
constexpr int kNearTries = 2, kNearest = 1, kFarther = 2;

// A vertex is tried less often if the area around it is more than kLarge times the mean one: twice
// that area halves the attempts. On a level sea all moves succeed, look at many posts, and gain
// nothing.
constexpr int64_t kLarge = 4;

// Posts that a vertex tries.
constexpr std::size_t kTries = 24;

// How many steps from its triangle an added vertex may be.
constexpr int kFarthestMove = 2;

uint16_t even(int coordinate) {
  return static_cast<uint16_t>(coordinate - coordinate % 2);
}

int16_t height(int32_t z) {
  return static_cast<int16_t>(std::clamp(z, -32768, 32767));
}

uint16_t neighbour_of(uint16_t coordinate, bool after) {
  return static_cast<uint16_t>(after ? coordinate + 1 : coordinate - 1);
}

}  // namespace

Attempts::Attempts(Surface& surface) : surface_(surface), edits_(surface), fit_(surface) {}

void Attempts::prefer(int32_t direction) {
  direction_ = direction;
  fit_.prefer(direction);
}

void Attempts::begin(uint64_t seed) {
  random_ = RandomNumbers(seed);
  first_ = edits_.size();
  fitted_.clear();
}

Outcome Attempts::outcome(bool is_removal) const {
  if (edits_.size() == first_) return {};
  const auto first = edits_.all().begin() + static_cast<std::ptrdiff_t>(first_);
  Outcome all{{first, edits_.all().end()}, {}, raised_, is_removal, {}};
  for (const Index v : fitted_) {
    if (!surface_.has_vertex(v)) continue;
    all.vertices.push_back(v);
    const std::vector<Index> neighbours = ring(v);
    all.vertices.insert(all.vertices.end(), neighbours.begin(), neighbours.end());
  }
  for (const Index v : all.vertices) all.region.add(surface_.place(v));
  for (const Edits::Edit& edit : all.edits) all.region.add({edit.before.x, edit.before.y});
  return all;
}

std::vector<Index> Attempts::ring(Index v) const {
  std::vector<Index> ring;
  surface_.visit_around(v, [&](Index h) {
    const Index neighbour = surface_.mesh().origin[next_in_triangle(h)];
    if (neighbour != kInfinity) ring.push_back(neighbour);
  });
  return ring;
}

// After a removal or an insertion: moves vertices up and down until all around is within bounds,
// and says whether it is.
bool Attempts::fit(const std::vector<Index>& vertices) {
  if (!fit_.fit(vertices, surface_.new_triangles())) return false;
  raised_ -= surface_.volume(fit_.changed());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (fit_.shift(i) == 0) continue;
    if (!edits_.set_height(vertices[i], surface_.height(vertices[i]) + fit_.shift(i))) return false;
  }
  raised_ += surface_.volume(fit_.changed());
  if (!std::all_of(fit_.changed().begin(), fit_.changed().end(),
                   [this](Index t) { return surface_.keeps_bounds(t); })) {
    return false;
  }
  fitted_.insert(fitted_.end(), vertices.begin(), vertices.end());
  return true;
}

// Nothing, and nothing has changed, if the vertex has too many neighbours.
std::optional<Attempts::Hole> Attempts::remove(Index v) {
  Hole hole{ring(v), -surface_.volume_around(v)};
  if (!edits_.remove(v)) return std::nullopt;
  hole.raised += surface_.volume(surface_.new_triangles());
  raised_ = hole.raised;
  return hole;
}

bool Attempts::remove_vertex(Index v) {
  const std::size_t before = edits_.size();
  const std::optional<Hole> hole = remove(v);
  if (!hole) return false;
  if (fit(hole->ring)) return true;
  edits_.roll_back(before);
  return false;
}

// Moves a vertex a little, or where the bound is missed without it. Says whether there is a vertex
// less.
bool Attempts::move_vertex(Index v) {
  if (is_passed_over(v)) return false;
  const Vertex old = surface_.vertex(v);
  const std::optional<Hole> hole = remove(v);
  if (!hole) return false;
  if (fit(hole->ring)) return true;
  const Sample& worst = surface_.survey().samples[fit_.worst_sample(random_.below(kRanks))];
  edits_.roll_back(first_ + 1);
  const bool is_cheaper = try_cheaper_posts(old, *hole);
  const Point far{cheap(worst.place.x), cheap(worst.place.y)};
  if (is_cheaper) return false;
  if (!try_near(old, *hole) && !try_post(far, old, *hole)) {
    edits_.roll_back(first_);
    return false;
  }
  const std::vector<Index> neighbours = ring(moved_);
  return std::any_of(neighbours.begin(), neighbours.end(),
                     [this](Index r) { return !surface_.is_fixed(r) && remove_vertex(r); });
}

// The number is below 2^33, the area of the lattice, twice.
bool Attempts::is_passed_over(Index v) {
  const int64_t large = kLarge * usual_area_, area = surface_.area_around(v);
  return area > large &&
         random_.below(static_cast<std::size_t>(area)) >= static_cast<uint64_t>(large);
}

// Moves a vertex that was removed to a random post near its own. Says whether it can be there.
bool Attempts::try_near(Vertex old, const Hole& hole) {
  for (int i = 0; i < kNearTries; ++i) {
    const int reach = random_.below(2) != 0 ? kNearest : kFarther;
    const auto beside = [&](uint16_t from) {
      return from + static_cast<int>(random_.below(2 * static_cast<std::size_t>(reach) + 1)) -
             reach;
    };
    const int x = beside(old.x), y = beside(old.y);
    if (std::min(x, y) < 0 || std::max(x, y) > kLatticeMax) continue;
    const Point to{cheap(static_cast<uint16_t>(x)), cheap(static_cast<uint16_t>(y))};
    if (try_post(to, old, hole)) return true;
  }
  return false;
}

// Moves a vertex that was removed to another post. Says whether there is one and it can be there.
bool Attempts::try_post(Point to, Vertex old, const Hole& hole) {
  if (to == Point{old.x, old.y}) return false;
  const std::optional<std::size_t> post = surface_.posts().find(to);
  return post && insert({to.x, to.y, nearest_height(*post)}, hole);
}

// The coordinate itself, or an even one next to it.
uint16_t Attempts::cheap(uint16_t coordinate) {
  constexpr std::size_t kParts = 1024;
  const bool rounded = static_cast<double>(random_.below(kParts)) < cheapness_ * kParts;
  if (coordinate % 2 == 0 || coordinate == kLatticeMax || !rounded) return coordinate;
  return neighbour_of(coordinate, random_.below(2) != 0);
}

int16_t Attempts::nearest_height(std::size_t post) const {
  return surface_.model().vertex_height(surface_.survey().samples[surface_.posts().number(post)]);
}

// Moves a vertex that was removed to a place next to its own that costs less, as far above the
// source. Says whether there is one.
bool Attempts::try_cheaper_posts(Vertex old, const Hole& hole) {
  for (const bool right : {false, true}) {
    for (const bool up : {false, true}) {
      const bool odd_x = old.x % 2 != 0, odd_y = old.y % 2 != 0;
      if ((!odd_x && right) || (!odd_y && up) || (!odd_x && !odd_y)) continue;
      const std::optional<Vertex> to = carried(old, odd_x ? neighbour_of(old.x, right) : old.x,
                                               odd_y ? neighbour_of(old.y, up) : old.y);
      if (to && insert(*to, hole)) return true;
    }
  }
  return false;
}

// A vertex at another post, as far above the source; nothing if there is no post.
std::optional<Vertex> Attempts::carried(Vertex old, int x, int y) const {
  if (std::min(x, y) < 0 || std::max(x, y) > kLatticeMax) return std::nullopt;
  const Point to{static_cast<uint16_t>(x), static_cast<uint16_t>(y)};
  const PostIndex& posts = surface_.posts();
  const std::optional<std::size_t> from = posts.find({old.x, old.y}), post = posts.find(to);
  if (!post) return std::nullopt;
  const double z = old.z + double{surface_.middles()[*post]} - double{surface_.middles()[*from]};
  const long height = std::lround(std::clamp(z, -32768.0, 32767.0));
  return Vertex{to.x, to.y, static_cast<int16_t>(height)};
}

// Puts a vertex in the hole that another left. Says whether it can be there.
bool Attempts::place(Vertex vertex, const Hole& hole) {
  const Index near = hole.ring[0];
  if (!surface_.can_insert({vertex.x, vertex.y}, surface_.edge_of(near))) return false;
  if (fit_.is_hopeless(vertex)) return false;
  raised_ = hole.raised - surface_.volume(surface_.new_triangles());  // those that are replaced
  moved_ = edits_.insert(vertex, near);
  raised_ += surface_.volume_around(moved_);
  return true;
}

// Places a vertex, and returns whether the bounds are kept then; nothing has changed if not.
bool Attempts::insert(Vertex vertex, const Hole& hole) {
  const std::size_t before = edits_.size();
  if (!place(vertex, hole)) return false;
  std::vector<Index> around = {moved_};  // first: what its triangles hold decides soonest
  around.insert(around.end(), hole.ring.begin(), hole.ring.end());
  for (const Index r : ring(moved_)) {
    if (!contains(around, r)) around.push_back(r);
  }
  if (fit(around)) return true;
  edits_.roll_back(before);
  return false;
}

// Says whether there is a vertex less.
bool Attempts::move_and_gain(Index v, int near) {
  const Vertex old = surface_.vertex(v);
  const std::optional<Hole> hole = remove(v);
  if (!hole) return false;
  const bool removed = fit(hole->ring) && gain() >= 0;
  if (removed) return true;
  edits_.roll_back(first_ + 1);
  if (!move_near(old, near, *hole)) edits_.roll_back(first_);
  return false;
}

// Moves a vertex that was removed to a post near its own, or back there with other heights around,
// so that the mean error comes nearer zero: to the one that brings it nearest before heights are
// fitted, of those that are tried and keep their bounds. Says whether there is one.
bool Attempts::move_near(Vertex old, int near, const Hole& hole) {
  std::vector<std::pair<int64_t, Vertex>> posts;  // and what they gain
  for (int x = old.x - near; x <= old.x + near; ++x) {
    const int rest = near - std::abs(x - old.x);
    for (int y = old.y - rest; y <= old.y + rest; ++y) {
      std::optional<Vertex> to = carried(old, x, y);
      if (!to || to->x % 2 + to->y % 2 > old.x % 2 + old.y % 2) continue;
      to->z = height(to->z + direction_);
      if (!place(*to, hole)) continue;
      posts.emplace_back(gain(), *to);
      edits_.roll_back(first_ + 1);
    }
  }
  std::stable_sort(posts.begin(), posts.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  const std::size_t tries = std::min(posts.size(), kTries);
  for (std::size_t i = 0; i < tries; ++i) {
    if (!insert(posts[i * posts.size() / tries].second, hole)) continue;
    if (gain() > 0) return true;
    edits_.roll_back(first_ + 1);
  }
  return false;
}

// A vertex at a cheap post near the middle of a triangle, as far from its middle height as fits.
std::optional<Attempts::Addition> Attempts::addition_in(const std::array<Index, 3>& corners) {
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
    const Vertex vertex{to.x, to.y, height(z / 3 + direction_ * steps)};
    if (!insert(vertex, Hole{{corners[0], corners[1], corners[2]}, 0})) continue;
    const int64_t gained = gain();
    edits_.roll_back(first_);
    return Addition{gained, vertex, corners[0]};
  }
  return std::nullopt;
}

bool Attempts::add(const Addition& addition) {
  if (!insert(addition.vertex, Hole{{addition.corner}, 0})) return false;
  if (2 * gain() >= addition.gain) return true;
  edits_.roll_back(first_);
  return false;
}

}  // namespace microtin::fit
