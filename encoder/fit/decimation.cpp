// SPDX-License-Identifier: MIT
// Removes and moves vertices one by one, and takes back what breaks a bound.
#include "encoder/fit/decimation.hpp"

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

// How much more odd coordinates may cost on the way: the search finds more when at first it
// takes the places that fit best.
constexpr double kDaring = 10, kCareful = 0.8;  // the part of the search after which none does

// Steps of a block's sides: on a raster its posts take 400 KB.
constexpr int kBlock = 128;

uint16_t neighbour_of(uint16_t coordinate, bool after) {
  return static_cast<uint16_t>(after ? coordinate + 1 : coordinate - 1);
}

}  // namespace

Decimation::Decimation(Surface& surface)
    : surface_(surface), edits_(surface), fit_(surface), stale_(surface.vertex_limit()) {}

std::size_t Decimation::remove_vertices(const Progress& progress) {
  const std::size_t removed = try_each(progress, [this](Index v) { return try_removal(v); });
  forget();  // what could not be removed has not been moved yet
  return removed;
}

std::size_t Decimation::remove_and_move_vertices(double done, const Progress& progress) {
  cheapness_ = std::pow(even_part(), kDaring * std::max(0.0, 1 - done / kCareful));
  return try_each(progress, [this](Index v) { return try_move(v); });
}

bool Decimation::remove_vertex(Index v) {
  const bool is_removed = try_removal(v);
  keep_edits();
  return is_removed;
}

// The coder learns how often coordinates are even: odd ones cost more by that.
double Decimation::even_part() const {
  std::size_t even = 0;
  for (Index v = 0; v < surface_.vertex_limit(); ++v) {
    if (surface_.has_vertex(v)) even += 2u - surface_.place(v).x % 2u - surface_.place(v).y % 2u;
  }
  return static_cast<double>(even) / (2.0 * surface_.vertices());
}

// Those that are not stale, block by block, since posts nearby are then at hand; within a block in
// an order that looks random.
std::vector<Index> Decimation::order_of_attempts() {
  std::vector<Index> order;
  for (Index v = 0; v < surface_.vertex_limit(); ++v) {
    if (surface_.has_vertex(v) && !surface_.is_fixed(v) && !stale_[v]) order.push_back(v);
  }
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random_below(i)]);
  const auto block = [this](Index v) {
    const Point p = surface_.place(v);
    return std::make_pair(p.x / kBlock, p.y / kBlock);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return block(a) < block(b); });
  return order;
}

std::size_t Decimation::try_each(const Progress& progress,
                                 const std::function<bool(Index)>& attempt) {
  const std::vector<Index> order = order_of_attempts();
  std::size_t removed = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Index v = order[i];
    if (i % 256 == 0) progress.at(static_cast<double>(i) / static_cast<double>(order.size()));
    if (!surface_.has_vertex(v)) continue;
    stale_[v] = true;
    if (attempt(v)) ++removed;
    keep_edits();
  }
  return removed;
}

// Knuth's linear congruential generator.
std::size_t Decimation::random_below(std::size_t limit) {
  random_ = random_ * 6364136223846793005u + 1442695040888963407u;
  return (random_ >> 33) % limit;
}

// Keeps what an attempt changed. What lies near a change may be tried again.
void Decimation::keep_edits() {
  if (edits_.size() != 0) {
    for (const Index v : fitted_) {
      if (!surface_.has_vertex(v)) continue;
      stale_[v] = false;
      for (const Index neighbour : ring(v)) stale_[neighbour] = false;
    }
  }
  edits_.commit();
  fitted_.clear();
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
  if (!fit_.fit(vertices)) return false;
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
std::optional<Decimation::Hole> Decimation::remove(Index v) {
  Hole hole{ring(v), -surface_.volume_around(v)};
  if (!edits_.remove(v)) return std::nullopt;
  hole.raised += surface_.volume(surface_.new_triangles());
  raised_ = hole.raised;
  return hole;
}

bool Decimation::try_removal(Index v) {
  const std::size_t before = edits_.size();
  const std::optional<Hole> hole = remove(v);
  if (!hole) return false;
  if (fit(hole->ring)) return true;
  edits_.roll_back(before);
  return false;
}

// Moves a vertex a little, or where the bound is missed without it. Says whether there is a vertex
// less.
bool Decimation::try_move(Index v) {
  const Vertex old = surface_.vertex(v);
  const std::optional<Hole> hole = remove(v);
  if (!hole) return false;
  if (fit(hole->ring)) return true;
  const Sample& worst = surface_.survey().samples[fit_.worst_sample(random_below(kRanks))];
  edits_.roll_back(1);
  const bool is_cheaper = try_cheaper_posts(old, *hole);
  const Point far{cheap(worst.place.x), cheap(worst.place.y)};
  if (is_cheaper) return false;
  if (!try_near(old, *hole) && !try_post(far, old, *hole)) {
    edits_.roll_back(0);
    return false;
  }
  const std::vector<Index> neighbours = ring(moved_);
  return std::any_of(neighbours.begin(), neighbours.end(),
                     [this](Index r) { return !surface_.is_fixed(r) && try_removal(r); });
}

// Moves a vertex that was removed to a random post near its own. Says whether it can be there.
bool Decimation::try_near(Vertex old, const Hole& hole) {
  for (int i = 0; i < kNearTries; ++i) {
    const int reach = random_below(2) != 0 ? kNearest : kFarther;
    const auto beside = [&](uint16_t from) {
      return from + static_cast<int>(random_below(2 * static_cast<std::size_t>(reach) + 1)) - reach;
    };
    const int x = beside(old.x), y = beside(old.y);
    if (std::min(x, y) < 0 || std::max(x, y) > kLatticeMax) continue;
    const Point to{cheap(static_cast<uint16_t>(x)), cheap(static_cast<uint16_t>(y))};
    if (try_post(to, old, hole)) return true;
  }
  return false;
}

// Moves a vertex that was removed to another post. Says whether there is one and it can be there.
bool Decimation::try_post(Point to, Vertex old, const Hole& hole) {
  if (to == Point{old.x, old.y}) return false;
  const std::optional<std::size_t> post = surface_.posts().find(to);
  return post && insert({to.x, to.y, nearest_height(*post)}, hole);
}

// The coordinate itself, or an even one next to it.
uint16_t Decimation::cheap(uint16_t coordinate) {
  constexpr std::size_t kParts = 1024;
  const bool rounded = static_cast<double>(random_below(kParts)) < cheapness_ * kParts;
  if (coordinate % 2 == 0 || coordinate == kLatticeMax || !rounded) return coordinate;
  return neighbour_of(coordinate, random_below(2) != 0);
}

int16_t Decimation::nearest_height(std::size_t post) const {
  return surface_.model().vertex_height(surface_.survey().samples[surface_.posts().number(post)]);
}

// Moves a vertex that was removed to a place next to its own that costs less, as far above the
// source. Says whether there is one.
bool Decimation::try_cheaper_posts(Vertex old, const Hole& hole) {
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
std::optional<Vertex> Decimation::carried(Vertex old, int x, int y) const {
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
bool Decimation::place(Vertex vertex, const Hole& hole) {
  const Index hint = surface_.edge_of(hole.ring[0]);
  if (!surface_.can_insert({vertex.x, vertex.y}, hint)) return false;
  raised_ = hole.raised - surface_.volume(surface_.new_triangles());  // those that are replaced
  moved_ = edits_.insert(vertex, hint);
  raised_ += surface_.volume_around(moved_);
  return true;
}

// Places a vertex, and returns whether the bounds are kept then; nothing has changed if not.
bool Decimation::insert(Vertex vertex, const Hole& hole) {
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

}  // namespace microtin::fit
