// SPDX-License-Identifier: MIT
// Incremental insertion in rounds along a Hilbert curve, with exact integers.
#include <algorithm>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/exact/wide.hpp"
#include "encoder/pack/point_tiles.hpp"
#include "encoder/stream/spatial_order.hpp"

namespace microtin::pack {
namespace {

// Coordinates are below 2^31, so each factor of these products is, too: all sums fit.
struct Difference {
  int64_t x, y;
};

Difference operator-(GlobalPost a, GlobalPost b) {
  return {int64_t{a.x} - b.x, int64_t{a.y} - b.y};
}

int64_t cross(Difference a, Difference b) {
  return a.x * b.y - a.y * b.x;
}

int64_t dot(Difference a, Difference b) {
  return a.x * b.x + a.y * b.y;
}

// Positive if c lies to the left of a -> b.
int64_t turn(GlobalPost a, GlobalPost b, GlobalPost c) {
  return cross(b - a, c - a);
}

// Whether p lies inside the circle through the counter-clockwise a, b, c: c and p compare the
// cotangents of the angles under which they see the chord from a to b.
bool is_in_circle(GlobalPost a, GlobalPost b, GlobalPost c, GlobalPost p) {
  return Wide{dot(a - c, b - c)} * cross(a - p, b - p) >
         Wide{dot(a - p, b - p)} * cross(a - c, b - c);
}

// Half of all points come in the last round, half of the rest in the one before (Amenta, Choi and
// Rote): 0 for the last.
uint32_t rounds_from_last(GlobalPost p) {
  uint64_t hash = scramble(uint64_t{p.x} << 32 | p.y);
  uint32_t rounds = 0;
  for (; rounds < 20 && (hash >> 63) == 0; hash <<= 1) ++rounds;
  return rounds;
}

std::vector<uint32_t> insertion_order(const std::vector<GlobalPost>& points) {
  struct Key {
    uint32_t rounds;
    uint64_t position;
    uint32_t point;
  };
  std::vector<Key> keys;
  keys.reserve(points.size());
  for (const GlobalPost p : points) {
    keys.push_back(
        {rounds_from_last(p), hilbert_position<31>(p.x, p.y), static_cast<uint32_t>(keys.size())});
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return a.rounds != b.rounds ? a.rounds > b.rounds : a.position < b.position;
  });
  std::vector<uint32_t> order;
  order.reserve(keys.size());
  for (const Key& key : keys) order.push_back(key.point);
  return order;
}

}  // namespace

GlobalTriangulation::GlobalTriangulation(std::vector<GlobalPost> points)
    : points_(std::move(points)), starting_at_(points_.size() + 1) {
  if (points_.size() > 300000000) throw Error("too many points to triangulate");
  std::vector<uint32_t> order = insertion_order(points_);
  start_with_triangle(order, [this](uint32_t a, uint32_t b, uint32_t c) {
    return turn(points_[a], points_[b], points_[c]);
  });
  origin_.reserve(6 * points_.size());
  twin_.reserve(6 * points_.size());
  start(order[0], order[1], order[2]);
  uint32_t near = 0;
  for (std::size_t i = 3; i < order.size(); ++i) {
    find_cavity(order[i], locate(points_[order[i]], near));
    fill_cavity(order[i]);
    near = cavity_.front();
  }
}

void GlobalTriangulation::start(uint32_t a, uint32_t b, uint32_t c) {
  add_triangle(a, b, c);
  add_triangle(b, a, infinity());
  add_triangle(c, b, infinity());
  add_triangle(a, c, infinity());
  for (uint32_t i = 0; i < 3; ++i) {
    const uint32_t ghost = 3 + 3 * i, after = 3 + 3 * ((i + 1) % 3);
    pair(i, ghost);
    pair(ghost + 2, after + 1);
  }
}

void GlobalTriangulation::add_triangle(uint32_t a, uint32_t b, uint32_t c) {
  origin_.insert(origin_.end(), {a, b, c});
  twin_.resize(origin_.size());
  seen_by_.push_back(infinity());
}

void GlobalTriangulation::pair(uint32_t g, uint32_t h) {
  twin_[g] = h;
  twin_[h] = g;
}

// The half-edge of a ghost that has the outside to its left; past the end of others.
uint32_t GlobalTriangulation::infinite_edge(uint32_t triangle) const {
  for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; ++h) {
    if (origin_[h] == infinity()) return next(h);
  }
  return 3 * triangle + 3;
}

bool GlobalTriangulation::conflicts(uint32_t triangle, GlobalPost p) const {
  const uint32_t h = infinite_edge(triangle), f = 3 * triangle;
  if (h == f + 3) {
    return is_in_circle(points_[origin_[f]], points_[origin_[f + 1]], points_[origin_[f + 2]], p);
  }
  const GlobalPost u = points_[origin_[h]], w = points_[origin_[next(h)]];
  const int64_t side = turn(u, w, p);
  if (side != 0) return side > 0;
  return u < w ? u < p && p < w : w < p && p < u;
}

// A triangle in conflict with p.
uint32_t GlobalTriangulation::locate(GlobalPost p, uint32_t triangle) const {
  const uint32_t hull = infinite_edge(triangle);
  if (hull != 3 * triangle + 3) triangle = twin_[hull] / 3;
  for (uint32_t h = 3 * triangle, left = 3; left > 0; --left, h = next(h)) {
    if (turn(points_[origin_[h]], points_[origin_[next(h)]], p) >= 0) continue;
    h = twin_[h];  // on a Delaunay triangulation no triangle is met twice
    triangle = h / 3;
    if (origin_[previous(h)] == infinity()) break;
    left = 3;  // of which the loop skips the one just crossed
  }
  return triangle;
}

void GlobalTriangulation::find_cavity(uint32_t v, uint32_t triangle) {
  const GlobalPost p = points_[v];
  cavity_.assign(1, triangle);
  sides_.clear();
  seen_by_[triangle] = v;
  for (std::size_t i = 0; i < cavity_.size(); ++i) {
    for (uint32_t h = 3 * cavity_[i], k = 0; k < 3; ++k, ++h) {
      const uint32_t behind = twin_[h] / 3;
      if (seen_by_[behind] == v) continue;
      if (conflicts(behind, p)) {
        seen_by_[behind] = v;
        cavity_.push_back(behind);
      } else {
        sides_.push_back({origin_[h], origin_[next(h)], twin_[h]});
      }
    }
  }
}

// Joins every side of the cavity to v. There are two sides more than triangles.
void GlobalTriangulation::fill_cavity(uint32_t v) {
  for (int i = 0; i < 2; ++i) {
    cavity_.push_back(static_cast<uint32_t>(origin_.size() / 3));
    add_triangle(v, v, v);
  }
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const uint32_t h = 3 * cavity_[i];
    origin_[h] = sides_[i].from;
    origin_[h + 1] = sides_[i].to;
    origin_[h + 2] = v;
    pair(h, sides_[i].outside);
    starting_at_[sides_[i].from] = h;
  }
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    pair(3 * cavity_[i] + 1, starting_at_[sides_[i].to] + 2);
  }
}

}  // namespace microtin::pack
