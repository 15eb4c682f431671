// SPDX-License-Identifier: MIT
// Greedy insertion: always the sample that is furthest from its bounds.
#include "encoder/fit/refinement.hpp"

#include <algorithm>

#include "encoder/fit/error_model.hpp"
#include "encoder/stream/triangulation.hpp"
#include "shared/interpolation.hpp"

namespace microtin::fit {
namespace {

std::vector<Point> places_of(const Survey& survey, const std::vector<uint32_t>& samples) {
  std::vector<Point> places;
  places.reserve(samples.size());
  for (const uint32_t s : samples) places.push_back(survey.samples[s].place);
  return places;
}

uint64_t squared_distance(Point a, Point b) {
  const int64_t dx = int64_t{a.x} - b.x, dy = int64_t{a.y} - b.y;
  return static_cast<uint64_t>(dx * dx + dy * dy);
}

}  // namespace

Refinement::Refinement(const Survey& survey, ErrorModel model, const PostIndex& posts,
                       const std::vector<Point>& places)
    : survey_(survey),
      model_(model),
      posts_(posts),
      void_posts_(survey.voids),
      triangulation_(places),
      is_vertex_(survey.samples.size()),
      on_rim_(survey.samples.size()) {}

Refinement::Refinement(const Survey& survey, ErrorModel model, const PostIndex& posts,
                       const std::vector<uint32_t>& corners)
    : Refinement(survey, model, posts, places_of(survey, corners)) {
  for (const uint32_t s : corners) add_vertex(s, model_.vertex_height(survey_.samples[s]));
  begin();
}

Refinement::Refinement(const Survey& survey, ErrorModel model, const PostIndex& posts,
                       const Tin& tin)
    : Refinement(survey, model, posts, places_of(tin)) {
  for (const Vertex& v : tin.vertices) {
    const uint32_t s = posts.number(*posts.find({v.x, v.y}));
    add_vertex(s, model_.nearest_height(survey_.samples[s], v.z));
  }
  begin();
}

void Refinement::add_vertex(uint32_t sample, int16_t height) {
  heights_.push_back(height);
  is_vertex_[sample] = true;
}

void Refinement::begin() {
  find_rims();
  set_triangles();
  for (Index t = 0; t < triangulation_.mesh().triangles; ++t) look_for_voids(t);
  for (Index t = 0; t < triangulation_.mesh().triangles; ++t) assess(t);
}

void Refinement::find_rims() {
  const auto before = [](const Sample& sample, Point p) { return sample.place < p; };
  for (const Point post : survey_.voids) {
    for (const int dx : {-1, 0, 1}) {
      for (const int dy : {-1, 0, 1}) {
        const int x = post.x + dx, y = post.y + dy;
        if (x < 0 || y < 0 || x > kLatticeMax || y > kLatticeMax) continue;
        const Point p{static_cast<uint16_t>(x), static_cast<uint16_t>(y)};
        const auto at = std::lower_bound(survey_.samples.begin(), survey_.samples.end(), p, before);
        if (at == survey_.samples.end() || at->place != p) continue;
        on_rim_[static_cast<std::size_t>(at - survey_.samples.begin())] = true;
      }
    }
  }
}

void Refinement::set_triangles() {
  void_.resize(triangulation_.mesh().triangles);
  worst_.resize(triangulation_.mesh().triangles);
}

template <class Visit>
void Refinement::visit_under(const PostIndex& posts, Index triangle, const Visit& visit) const {
  const Mesh& mesh = triangulation_.mesh();
  const Index* const corner = mesh.origin + first_edge(triangle);
  posts.visit_under(point_of(mesh, corner[0]), point_of(mesh, corner[1]), point_of(mesh, corner[2]),
                    visit);
}

void Refinement::look_for_voids(Index triangle) {
  void_[triangle] = false;
  if (survey_.voids.empty() || !is_real(triangle)) return;
  visit_under(void_posts_, triangle, [&](uint32_t, Point) { void_[triangle] = true; });
}

void Refinement::refine(std::size_t max_vertices) {
  while (!queue_.empty()) {
    const Entry worst = queue_.top();
    if (worst.candidate.urgency < kUncovered && heights_.size() >= max_vertices) return;
    queue_.pop();
    // Entries that no longer hold are left in the queue until they come up.
    if (worst_[worst.triangle] == worst.candidate) insert(worst.candidate.sample, worst.triangle);
  }
}

void Refinement::insert(uint32_t sample, Index triangle) {
  const Mesh& mesh = triangulation_.mesh();
  triangulation_.insert(survey_.samples[sample].place, first_edge(triangle));
  add_vertex(sample, model_.vertex_height(survey_.samples[sample]));
  set_triangles();
  for (const Index t : triangulation_.new_triangles()) look_for_voids(t);
  for (const Index t : triangulation_.new_triangles()) assess(t);
  if (survey_.voids.empty()) return;
  // What lies on an edge of a void triangle depends on the triangle behind.
  for (const Index t : triangulation_.new_triangles()) {
    const Index behind = triangle_of(mesh.twin[first_edge(t)]);
    if (void_[behind]) assess(behind);
  }
}

// Finds the worst sample of a triangle.
void Refinement::assess(Index triangle) {
  Candidate& worst = worst_[triangle];
  worst = {0, 0};
  if (!is_real(triangle)) return;
  worst = void_[triangle] ? worst_in_void(triangle) : worst_within(triangle);
  if (worst.urgency != 0) queue_.push({worst, triangle});
}

// Floating point rules out nearly all samples. It is less than a unit from the exact height, which
// is rounded by half of one.
Refinement::Candidate Refinement::worst_within(Index triangle) const {
  const Mesh& mesh = triangulation_.mesh();
  const Index f = first_edge(triangle);
  const Vertex a = vertex(mesh.origin[f]), b = vertex(mesh.origin[f + 1]),
               c = vertex(mesh.origin[f + 2]);
  const Plane plane(a, b, c);
  Candidate worst = {0, 0};
  constexpr double kRounding = 2;
  double least = -kRounding;  // violation that matters
  posts_.visit_runs({a.x, a.y}, {b.x, b.y}, {c.x, c.y}, [&](const PostIndex::Run& run) {
    for (std::size_t i = run.first; i < run.last; ++i) {
      const Point place = posts_.place_in(run, i);
      const uint32_t s = posts_.number(i);
      const auto [lowest, highest] = model_.allowed(survey_.samples[s]);
      const double height = plane.at(place) * 65536;
      const double below = static_cast<double>(lowest) - height;
      const double above = height - static_cast<double>(highest);
      if (std::max(below, above) < least || is_vertex_[s]) continue;
      const int32_t surface = height_in_triangle(a, b, c, fine(place));
      const Candidate candidate = {model_.violation(survey_.samples[s], surface), s};
      if (!(worst < candidate)) continue;
      worst = candidate;
      least = static_cast<double>(worst.urgency) - kRounding;
    }
  });
  return worst;
}

// The worst of those that only void triangles hold, or else of those on edges of others.
Refinement::Candidate Refinement::worst_in_void(Index triangle) const {
  const Mesh& mesh = triangulation_.mesh();
  const Index f = first_edge(triangle);
  const Vertex a = vertex(mesh.origin[f]), b = vertex(mesh.origin[f + 1]),
               c = vertex(mesh.origin[f + 2]);
  Candidate worst = {0, 0};
  visit_under(posts_, triangle, [&](uint32_t s, Point place) {
    if (is_vertex_[s]) return;
    Candidate candidate = {0, s};
    if (!on_covered_edge(triangle, place)) {
      candidate.urgency = uncovered_urgency(triangle, s);
    } else {
      const int32_t surface = height_in_triangle(a, b, c, fine(place));
      candidate.urgency = model_.violation(survey_.samples[s], surface);
    }
    if (worst < candidate) worst = candidate;
  });
  return worst;
}

bool Refinement::is_real(Index triangle) const {
  const Index* corner = triangulation_.mesh().origin + first_edge(triangle);
  return corner[0] != kInfinity && corner[1] != kInfinity && corner[2] != kInfinity;
}

// Whether p lies on an edge behind which there is terrain.
bool Refinement::on_covered_edge(Index triangle, Point p) const {
  const Mesh& mesh = triangulation_.mesh();
  for (Index h = first_edge(triangle); h < first_edge(triangle) + 3; ++h) {
    const Point from = point_of(mesh, mesh.origin[h]);
    const Point to = point_of(mesh, mesh.origin[next_in_triangle(h)]);
    const Index behind = triangle_of(mesh.twin[h]);
    if (orient2d(from, to, p) == 0 && is_real(behind) && !void_[behind]) return true;
  }
  return false;
}

// Rims first: they keep terrain and void apart. Of a rim that which is farthest from the triangle's
// corners; this found fewer vertices than to prefer those near to, or far from, its sides.
uint64_t Refinement::uncovered_urgency(Index triangle, uint32_t sample) const {
  const Mesh& mesh = triangulation_.mesh();
  const Point p = survey_.samples[sample].place;
  uint64_t distance = kOnRim - 1;
  for (Index h = first_edge(triangle); h < first_edge(triangle) + 3; ++h) {
    distance = std::min(distance, squared_distance(p, point_of(mesh, mesh.origin[h])));
  }
  return kUncovered + (on_rim_[sample] ? kOnRim : 0) + distance;
}

Vertex Refinement::vertex(Index v) const {
  const Point p = point_of(triangulation_.mesh(), v);
  return {p.x, p.y, heights_[v]};
}

Tin Refinement::tin() const {
  const Mesh& mesh = triangulation_.mesh();
  Tin tin;
  for (Index v = 0; v < mesh.vertices; ++v) tin.vertices.push_back(vertex(v));
  for (Index t = 0; t < mesh.triangles; ++t) {
    if (void_[t]) tin.voids.push_back(listed_triangle(mesh, t));
  }
  return tin;
}

}  // namespace microtin::fit
