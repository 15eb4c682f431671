#include "encoder/refinement.hpp"

#include <algorithm>

#include "shared/interpolation.hpp"

namespace microtin {
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

// Finds, for places close to one another, the triangle of a star that holds them.
class StarLocator {
 public:
  StarLocator(const Triangulation& triangulation, Index v)
      : mesh_(triangulation.mesh()), triangles_(triangulation.new_triangles()), v_(v) {
    while (at_ghost()) advance(1);
  }

  // p, not v itself, lies in the closed star and in the hull. The turn towards it passes through
  // less than half a circle, none of it outside.
  Index locate(Point p) {
    const Point centre = point_of(mesh_, v_);
    for (;;) {
      const Index h = first_edge(triangles_[at_]);
      if (orient2d(centre, point_of(mesh_, mesh_.origin[h]), p) < 0) {
        advance(triangles_.size() - 1);
      } else if (orient2d(centre, point_of(mesh_, mesh_.origin[h + 1]), p) > 0) {
        advance(1);
      } else {
        return triangles_[at_];
      }
    }
  }

 private:
  void advance(std::size_t steps) { at_ = (at_ + steps) % triangles_.size(); }

  bool at_ghost() const {
    const Index h = first_edge(triangles_[at_]);
    return mesh_.origin[h] == kInfinity || mesh_.origin[h + 1] == kInfinity;
  }

  const Mesh& mesh_;
  const std::vector<Index>& triangles_;
  Index v_;
  std::size_t at_ = 0;
};

}  // namespace

Refinement::Refinement(const Survey& survey, ErrorModel model, const std::vector<uint32_t>& corners)
    : survey_(survey),
      model_(model),
      triangulation_(places_of(survey, corners)),
      samples_(survey.samples.size()),
      voids_(survey.voids.size()),
      on_rim_(survey.samples.size()) {
  for (const uint32_t s : corners) heights_.push_back(model_.vertex_height(survey_.samples[s]));
  find_rims();
  set_triangles();
  distribute(corners);
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
  const std::size_t triangles = triangulation_.mesh().triangles;
  samples_.set_triangles(triangles);
  voids_.set_triangles(triangles);
  void_edges_.resize(3 * triangles);
  worst_.resize(triangles);
}

// Puts every post that is within the hull and no vertex into a list.
void Refinement::distribute(const std::vector<uint32_t>& vertices) {
  std::vector<bool> is_vertex(survey_.samples.size());
  for (const uint32_t s : vertices) is_vertex[s] = true;
  Index hint = 0;
  for (uint32_t s = 0; s < survey_.samples.size(); ++s) {
    if (is_vertex[s]) continue;
    hint = triangulation_.locate(survey_.samples[s].place, hint);
    samples_.push(triangle_of(hint), s);
  }
  for (uint32_t i = 0; i < survey_.voids.size(); ++i) {
    hint = triangulation_.locate(survey_.voids[i], hint);
    if (is_real(triangle_of(hint))) add_void(triangle_of(hint), i);
  }
}

void Refinement::add_void(Index triangle, uint32_t post) {
  const Mesh& mesh = triangulation_.mesh();
  voids_.push(triangle, post);
  for (Index h = first_edge(triangle); h < first_edge(triangle) + 3; ++h) {
    const Point from = point_of(mesh, mesh.origin[h]);
    const Point to = point_of(mesh, mesh.origin[next_in_triangle(h)]);
    if (orient2d(from, to, survey_.voids[post]) != 0) continue;
    void_edges_[h] = 1;
    void_edges_[mesh.twin[h]] = 1;
  }
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
  const Index v = triangulation_.insert(survey_.samples[sample].place, first_edge(triangle));
  heights_.push_back(model_.vertex_height(survey_.samples[sample]));
  set_triangles();
  redistribute(v);
  for (const Index t : triangulation_.new_triangles()) assess(t);
  if (survey_.voids.empty()) return;
  // What lies on an edge of a void triangle depends on the triangle behind.
  for (const Index t : triangulation_.new_triangles()) {
    const Index behind = triangle_of(mesh.twin[first_edge(t)]);
    if (is_void(behind)) assess(behind);
  }
}

// Gives the posts of the triangles that the insertion of v replaced to those that it made.
void Refinement::redistribute(Index v) {
  const Mesh& mesh = triangulation_.mesh();
  taken_samples_.clear();
  taken_voids_.clear();
  for (const Index t : triangulation_.new_triangles()) {
    samples_.take(t, taken_samples_);
    voids_.take(t, taken_voids_);
    const Index side = first_edge(t);
    void_edges_[side] = void_edges_[mesh.twin[side]];
    void_edges_[side + 1] = void_edges_[side + 2] = 0;
  }
  StarLocator star(triangulation_, v);
  const Point place = point_of(mesh, v);
  for (const uint32_t s : taken_samples_) {
    const Point p = survey_.samples[s].place;
    if (p != place) samples_.push(star.locate(p), s);
  }
  for (const uint32_t i : taken_voids_) add_void(star.locate(survey_.voids[i]), i);
}

// Finds the worst sample of a triangle.
void Refinement::assess(Index triangle) {
  Candidate& worst = worst_[triangle];
  worst = {0, 0};
  if (samples_.first(triangle) == PostLists::kEnd) return;
  const Mesh& mesh = triangulation_.mesh();
  const bool in_void = is_void(triangle);
  const Index f = first_edge(triangle);
  const Vertex a = vertex(mesh.origin[f]), b = vertex(mesh.origin[f + 1]),
               c = vertex(mesh.origin[f + 2]);
  for (uint32_t s = samples_.first(triangle); s != PostLists::kEnd; s = samples_.next(s)) {
    const Sample& sample = survey_.samples[s];
    Candidate candidate = {0, s};
    if (in_void && !on_covered_edge(triangle, sample.place)) {
      candidate.urgency = uncovered_urgency(triangle, s);
    } else {
      const int32_t surface = height_in_triangle(a, b, c, fine(sample.place));
      candidate.urgency = model_.violation(sample, surface);
    }
    if (worst < candidate) worst = candidate;
  }
  if (worst.urgency != 0) queue_.push({worst, triangle});
}

bool Refinement::is_real(Index triangle) const {
  const Index* corner = triangulation_.mesh().origin + first_edge(triangle);
  return corner[0] != kInfinity && corner[1] != kInfinity && corner[2] != kInfinity;
}

bool Refinement::is_void(Index triangle) const {
  const Index f = first_edge(triangle);
  return is_real(triangle) && (voids_.first(triangle) != PostLists::kEnd || void_edges_[f] != 0 ||
                               void_edges_[f + 1] != 0 || void_edges_[f + 2] != 0);
}

// Whether p lies on an edge behind which there is terrain.
bool Refinement::on_covered_edge(Index triangle, Point p) const {
  const Mesh& mesh = triangulation_.mesh();
  for (Index h = first_edge(triangle); h < first_edge(triangle) + 3; ++h) {
    const Point from = point_of(mesh, mesh.origin[h]);
    const Point to = point_of(mesh, mesh.origin[next_in_triangle(h)]);
    const Index behind = triangle_of(mesh.twin[h]);
    if (orient2d(from, to, p) == 0 && is_real(behind) && !is_void(behind)) return true;
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
    if (!is_void(t)) continue;
    Point corner[3];
    for (Index i = 0; i < 3; ++i) corner[i] = point_of(mesh, mesh.origin[first_edge(t) + i]);
    std::rotate(corner, std::min_element(corner, corner + 3), corner + 3);
    tin.voids.push_back({corner[0], corner[1], corner[2]});
  }
  return tin;
}

}  // namespace microtin
