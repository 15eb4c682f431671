// SPDX-License-Identifier: MIT
// A triangulated surface over a survey whose vertices come, go and move up and down.
#ifndef MICROTIN_ENCODER_FIT_SURFACE_HPP
#define MICROTIN_ENCODER_FIT_SURFACE_HPP

#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/fit/error_model.hpp"
#include "encoder/fit/post_index.hpp"
#include "encoder/layers.hpp"
#include "encoder/stream/triangulation.hpp"
#include "encoder/terrain/survey.hpp"

namespace microtin::fit {

// A copy has the same vertices with the same numbers, and shares what never changes.
class Surface {
 public:
  // The survey, the index of its samples and their limits must outlive this. The vertices of `tin`
  // get their numbers there.
  Surface(const Survey& survey, ErrorModel model, const PostIndex& posts, const PostLimits& limits,
          const Tin& tin);

  const Survey& survey() const { return survey_; }
  const ErrorModel& model() const { return model_; }
  const PostIndex& posts() const { return posts_; }
  const Mesh& mesh() const { return triangulation_.mesh(); }
  const Triangulation& triangulation() const { return triangulation_; }

  // As in PostLimits.
  const float* middles() const { return limits_.middles.data(); }
  const float* radii() const { return limits_.radii.data(); }
  std::size_t bounded_posts() const { return limits_.bounded_posts; }
  double mean_radius() const { return limits_.mean_radius; }
  int32_t widest_stride() const { return limits_.widest_stride; }

  // Every vertex number is below that, those of removed vertices too.
  Index vertex_limit() const { return static_cast<Index>(heights_.size()); }
  // How many there are.
  Index vertices() const { return vertices_; }
  bool has_vertex(Index v) const { return triangulation_.has_vertex(v); }
  Point place(Index v) const { return point_of(mesh(), v); }
  Vertex vertex(Index v) const { return {place(v).x, place(v).y, heights_[v]}; }
  int16_t height(Index v) const { return heights_[v]; }
  void set_height(Index v, int16_t height) { heights_[v] = height; }

  Index edge_of(Index v) const { return triangulation_.edge_of(v); }

  // Corners of the hull, vertices at voids and those that the survey has as fixed stay where they
  // are.
  bool is_fixed(Index v) const { return fixed_[v]; }

  // Neither a ghost nor void.
  bool is_covered(Index triangle) const;

  // Whether the posts under a covered triangle, or under all at a vertex, are within their bounds.
  bool keeps_bounds(Index triangle) const;
  bool keeps_bounds_around(Index v) const;

  // The heights of v for which that holds, all else as it is, rounded: the ends may be one step too
  // far out. Empty (low > high) if there is none.
  struct Interval {
    int32_t low, high;
    double best;       // where the sum of squared errors is smallest
    double curvature;  // the sum is this times the square of the distance from there, and more
  };
  Interval allowed_heights(Index v) const;

  // Removes a vertex that is not fixed. False, and nothing changes, if it has too many neighbours.
  bool remove(Index v);

  // Adds a vertex near a half-edge, where can_insert says so and there were more at first.
  Index insert(Vertex vertex, Index hint);

  // Takes back the last removal or insertion that was neither taken back nor kept. All numbers are
  // as before, also those of triangles.
  void take_back_removal(Vertex vertex);
  void take_back_insertion();
  void keep_changes() { triangulation_.forget_changes(); }

  // The triangles that the last change made, or after can_insert those that would be replaced.
  const std::vector<Index>& new_triangles() const { return triangulation_.new_triangles(); }

  // Whether there is no vertex yet, and an insertion would replace no void triangle and could be
  // taken back by remove.
  bool can_insert(Point p, Index hint);

  // After can_insert: calls visit(a, b) for the sides of the covered triangles that the insertion
  // would make at p, which lies to the left of each, until it says false.
  template <class Visit>
  void visit_rim(const Visit& visit) const {
    const Index size = triangulation_.rim_size();
    Index a = triangulation_.rim(size - 1);
    for (Index i = 0; i < size; ++i) {
      const Index b = triangulation_.rim(i);
      if (a != kInfinity && b != kInfinity && !visit(vertex(a), vertex(b))) return;
      a = b;
    }
  }

  // Calls visit(half-edge) for every half-edge that starts at v.
  template <class Visit>
  void visit_around(Index v, const Visit& visit) const {
    const Index start = triangulation_.edge_of(v);
    Index h = start;
    do {
      visit(h);
      h = mesh().twin[previous_in_triangle(h)];
    } while (h != start);
  }

  // Calls visit(triangle) for every covered triangle.
  template <class Visit>
  void visit_covered(const Visit& visit) const {
    for (Index v = 0; v < vertex_limit(); ++v) {
      if (!has_vertex(v)) continue;
      visit_around(v, [&](Index h) {
        const Index b = mesh().origin[next_in_triangle(h)];
        const Index c = mesh().origin[previous_in_triangle(h)];
        if (v < b && v < c && is_covered(triangle_of(h))) visit(triangle_of(h));
      });
    }
  }

  // Six times the volume between covered triangles and height 0, and the area that is covered,
  // twice: the mean height is a third of the one by the other.
  int64_t volume(const std::vector<Index>& triangles) const;
  int64_t volume_around(Index v) const;
  int64_t covered_area() const;
  int64_t area_around(Index v) const;

  Tin tin() const;

 private:
  int64_t volume(Index triangle) const;
  int64_t area(Index triangle) const;
  void find_voids();
  void find_corners();
  void find_fixed_samples();

  const Survey& survey_;
  ErrorModel model_;
  const PostIndex& posts_;
  const PostLimits& limits_;
  Triangulation triangulation_;
  Index vertices_;
  std::vector<int16_t> heights_;      // by vertex
  std::vector<bool> fixed_;           // by vertex
  std::vector<bool> void_;            // by triangle
  std::vector<Tin::Triangle> voids_;  // the same triangles
};

// Changes of a surface that can be taken back.

class Edits {
 public:
  // One change.
  struct Edit {
    enum Kind : uint8_t { kRemoval, kInsertion, kHeight } kind;
    Index vertex;
    Index neighbour;  // of a vertex that comes
    Vertex before, after;
  };

  // The surface must outlive this; nobody else changes it meanwhile.
  explicit Edits(Surface& surface) : surface_(surface) {}

  // As that of Surface.
  bool remove(Index v);

  // Adds a vertex near another one, where can_insert says so.
  Index insert(Vertex vertex, Index neighbour);

  // False, and nothing changes, if the height does not fit 16 bits.
  bool set_height(Index v, int32_t height);

  // How many there are, and back to when there were this many.
  std::size_t size() const { return edits_.size(); }
  void roll_back(std::size_t size);

  // Keeps them all.
  void commit();

  // In their order.
  const std::vector<Edit>& all() const { return edits_; }

 private:
  Surface& surface_;
  std::vector<Edit> edits_;
};

// Repeats a change that was made on a copy. The vertices around must be as they were there.
void apply(Surface& surface, const Edits::Edit& edit);

}  // namespace microtin::fit

#endif
