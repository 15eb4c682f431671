// SPDX-License-Identifier: MIT
// Heights on a triangulation: which posts lie where, whether they keep their bounds, and what
// changed.
#include "encoder/fit/surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "encoder/stream/triangulation.hpp"
#include "shared/interpolation.hpp"

namespace microtin::fit {

// Heights on a triangulation: which posts lie where, and whether they keep their bounds.

namespace {

// The least weight of a corner at a post is 2^-32, but for rounding.
constexpr double kNoWeight = 1e-10;

}  // namespace

Surface::Surface(const Survey& survey, ErrorModel model, const PostIndex& posts,
                 const PostLimits& limits, const Tin& tin)
    : survey_(survey),
      model_(model),
      posts_(posts),
      limits_(limits),
      triangulation_(places_of(tin)),
      vertices_(static_cast<Index>(tin.vertices.size())),
      fixed_(tin.vertices.size()),
      void_(triangulation_.mesh().triangles),
      voids_(tin.voids) {
  triangulation_.log_changes();
  heights_.reserve(tin.vertices.size());
  for (const Vertex& v : tin.vertices) heights_.push_back(v.z);
  find_voids();
  find_corners();
  find_fixed_samples();
}

void Surface::find_voids() {
  const VoidTriangles voids(voids_);
  if (voids.empty()) return;
  for (Index t = 0; t < mesh().triangles; ++t) {
    if (!is_covered(t) || !voids.has(mesh(), t)) continue;
    void_[t] = true;
    const Index* const corner = mesh().origin + first_edge(t);
    for (Index i = 0; i < 3; ++i) fixed_[corner[i]] = true;
  }
}

void Surface::find_corners() {
  visit_around(kInfinity, [&](Index h) {
    const Index next = mesh().twin[previous_in_triangle(h)];
    const Index after = mesh().twin[previous_in_triangle(next)];
    const Index a = mesh().origin[next_in_triangle(h)], b = mesh().origin[next_in_triangle(next)],
                c = mesh().origin[next_in_triangle(after)];
    if (orient2d(place(a), place(b), place(c)) != 0) fixed_[b] = true;
  });
}

void Surface::find_fixed_samples() {
  const std::vector<Point>& fixed = survey_.fixed;
  for (Index v = 0; v < vertex_limit(); ++v) {
    if (std::binary_search(fixed.begin(), fixed.end(), place(v))) fixed_[v] = true;
  }
}

bool Surface::is_covered(Index triangle) const {
  const Index* const corner = mesh().origin + first_edge(triangle);
  return !void_[triangle] && !is_ghost(corner[0], corner[1], corner[2]);
}

bool Surface::keeps_bounds(Index triangle) const {
  const Index* const corner = mesh().origin + first_edge(triangle);
  const Vertex a = vertex(corner[0]), b = vertex(corner[1]), c = vertex(corner[2]);
  const Plane plane(a, b, c);
  const float *const middle = middles(), *const radius = radii();
  bool keeps = true;
  posts_.visit_runs(place(corner[0]), place(corner[1]), place(corner[2]),
                    [&](const PostIndex::Run& run) {
                      for (std::size_t i = run.first; i < run.last && keeps; ++i) {
                        const Point p = posts_.place_in(run, i);
                        const double error = std::abs(plane.at(p) - double{middle[i]});
                        if (error < static_cast<double>(radius[i]) - kLimitError) continue;
                        const int32_t surface = height_in_triangle(a, b, c, fine(p));
                        keeps = model_.violation(survey_.samples[posts_.number(i)], surface) == 0;
                      }
                    });
  return keeps;
}

bool Surface::keeps_bounds_around(Index v) const {
  bool keeps = true;
  visit_around(v, [&](Index h) {
    const Index t = triangle_of(h);
    keeps = keeps && (!is_covered(t) || keeps_bounds(t));
  });
  return keeps;
}

Surface::Interval Surface::allowed_heights(Index v) const {
  double low = std::numeric_limits<int16_t>::min(), high = std::numeric_limits<int16_t>::max();
  double weights = 0, heights = 0;  // squared, and times what would be exact
  bool covered = false;
  visit_around(v, [&](Index h) {
    if (!is_covered(triangle_of(h))) return;
    covered = true;
    const Vertex b = vertex(mesh().origin[next_in_triangle(h)]),
                 c = vertex(mesh().origin[previous_in_triangle(h)]);
    const Point pa = place(v), pb{b.x, b.y}, pc{c.x, c.y};
    // What v adds, and the others: planes, which are 1 and 0 at v.
    const Plane own({pa.x, pa.y, 1}, {pb.x, pb.y, 0}, {pc.x, pc.y, 0});
    const Plane rest({pa.x, pa.y, 0}, b, c);
    posts_.visit_runs(pa, pb, pc, [&](const PostIndex::Run& run) {
      for (std::size_t i = run.first; i < run.last; ++i) {
        const Point p = posts_.place_in(run, i);
        const double weight = own.at(p);
        if (weight < kNoWeight) continue;
        const double others = rest.at(p), middle = double{middles()[i]}, inverse = 1 / weight;
        const auto radius = static_cast<double>(radii()[i]);
        low = std::max(low, (middle - radius - others) * inverse);
        high = std::min(high, (middle + radius - others) * inverse);
        weights += weight * weight;
        heights += weight * (survey_.samples[posts_.number(i)].height / 65536.0 - others);
      }
    });
  });
  if (!covered) return {heights_[v], heights_[v], 0, 0};  // nothing around says what is allowed
  constexpr double kSlack = 1e-4, kBeyond = 65536;
  return {static_cast<int32_t>(std::ceil(std::min(low, kBeyond) - kSlack)),
          static_cast<int32_t>(std::floor(std::max(high, -kBeyond) + kSlack)),
          weights != 0 ? heights / weights : 0, weights};
}

bool Surface::remove(Index v) {
  if (!triangulation_.remove(v, Triangulation::kMaxRemovable)) return false;
  --vertices_;
  return true;
}

Index Surface::insert(Vertex vertex, Index hint) {
  const Index v = triangulation_.insert({vertex.x, vertex.y}, hint);
  heights_[v] = vertex.z;
  ++vertices_;
  return v;
}

void Surface::take_back_removal(Vertex vertex) {
  heights_[triangulation_.undo()] = vertex.z;
  ++vertices_;
}

void Surface::take_back_insertion() {
  triangulation_.undo();
  --vertices_;
}

bool Surface::can_insert(Point p, Index hint) {
  const std::vector<Index>& replaced = triangulation_.conflicts(p, hint);
  return !replaced.empty() && replaced.size() + 2 <= Triangulation::kMaxRemovable &&
         std::none_of(replaced.begin(), replaced.end(), [this](Index t) { return void_[t]; });
}

// Below 2^33 (area, of which all together have no more) times 2^17.
int64_t Surface::volume(Index triangle) const {
  const int64_t covered = area(triangle);
  if (covered == 0) return 0;  // a ghost has a corner without a height
  const Index* const corner = mesh().origin + first_edge(triangle);
  const int64_t heights = int64_t{heights_[corner[0]]} + heights_[corner[1]] + heights_[corner[2]];
  return covered * heights;
}

int64_t Surface::area(Index triangle) const {
  if (!is_covered(triangle)) return 0;
  const Index* const corner = mesh().origin + first_edge(triangle);
  return orient2d(place(corner[0]), place(corner[1]), place(corner[2]));
}

int64_t Surface::volume(const std::vector<Index>& triangles) const {
  int64_t sum = 0;
  for (const Index t : triangles) sum += volume(t);
  return sum;
}

int64_t Surface::volume_around(Index v) const {
  int64_t sum = 0;
  visit_around(v, [&](Index h) { sum += volume(triangle_of(h)); });
  return sum;
}

int64_t Surface::covered_area() const {
  int64_t sum = 0;
  visit_covered([&](Index t) { sum += area(t); });
  return sum;
}

int64_t Surface::area_around(Index v) const {
  int64_t sum = 0;
  visit_around(v, [&](Index h) { sum += area(triangle_of(h)); });
  return sum;
}

Tin Surface::tin() const {
  Tin tin;
  for (Index v = 0; v < vertex_limit(); ++v) {
    if (has_vertex(v)) tin.vertices.push_back(vertex(v));
  }
  tin.voids = voids_;
  return tin;
}

// Remembers what changed, last first, to take it back.

bool Edits::remove(Index v) {
  const Vertex before = surface_.vertex(v);
  const Edit edit{Edit::kRemoval, v, 0, before, before};
  if (!surface_.remove(v)) return false;
  edits_.push_back(edit);
  return true;
}

Index Edits::insert(Vertex vertex, Index neighbour) {
  const Index v = surface_.insert(vertex, surface_.edge_of(neighbour));
  edits_.push_back({Edit::kInsertion, v, neighbour, vertex, vertex});
  return v;
}

bool Edits::set_height(Index v, int32_t height) {
  using Range = std::numeric_limits<int16_t>;
  if (height < Range::min() || height > Range::max()) return false;
  const Vertex before = surface_.vertex(v);
  const Vertex after{before.x, before.y, static_cast<int16_t>(height)};
  edits_.push_back({Edit::kHeight, v, 0, before, after});
  surface_.set_height(v, after.z);
  return true;
}

void Edits::commit() {
  edits_.clear();
  surface_.keep_changes();
}

void Edits::roll_back(std::size_t size) {
  for (; edits_.size() > size; edits_.pop_back()) {
    const Edit& edit = edits_.back();
    switch (edit.kind) {
      case Edit::kRemoval:
        surface_.take_back_removal(edit.before);
        break;
      case Edit::kInsertion:
        surface_.take_back_insertion();
        break;
      case Edit::kHeight:
        surface_.set_height(edit.vertex, edit.before.z);
        break;
    }
  }
}

void apply(Surface& surface, const Edits::Edit& edit) {
  switch (edit.kind) {
    case Edits::Edit::kRemoval:
      surface.remove(edit.vertex);
      break;
    case Edits::Edit::kInsertion:
      surface.insert(edit.after, surface.edge_of(edit.neighbour));
      break;
    case Edits::Edit::kHeight:
      surface.set_height(edit.vertex, edit.after.z);
      break;
  }
  surface.keep_changes();
}

}  // namespace microtin::fit
