// SPDX-License-Identifier: MIT
// Heights of a few vertices that bring all posts around them within their bounds.
#ifndef MICROTIN_ENCODER_FIT_HEIGHT_FIT_HPP
#define MICROTIN_ENCODER_FIT_HEIGHT_FIT_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "encoder/fit/surface.hpp"
#include "encoder/layers.hpp"

namespace microtin::fit {

// A descent: one step of one height after the other, each that which lowers the sum of squared
// excesses over the bounds most. It works with rounded numbers, so what it finds is to be checked.
class HeightFit {
 public:
  // The surface must outlive this.
  explicit HeightFit(const Surface& surface);

  // Looks for heights of these vertices, all else as it is. Says whether all posts around them are
  // within their bounds then. The surface stays as it is. Triangles between them may be out of
  // bounds: what no heights mend there alone is given up soon. All others keep theirs. `new_ones`
  // are among those between them, or ghosts: where bounds are most likely to be missed.
  bool fit(const std::vector<Index>& vertices, const std::vector<Index>& new_ones);

  // Whether `fit` would give up at once after this vertex is inserted, where can_insert has just
  // said that it can be: one look, without a change of the triangulation.
  bool is_hopeless(Vertex vertex) const;

  // Heights that are free then to go one step nearer to the source go up or down instead (1, -1; 0:
  // no longer).
  void prefer(int32_t direction) { preferred_ = direction; }

  // What the last call found: the change of a height, by place in `vertices`, ...
  int32_t shift(std::size_t vertex) const { return movers_[vertex].shift; }

  // The covered triangles between vertices, or with one that moves, and, after a call that
  // found nothing, the worst sample of the triangle that is worst, or second worst, ..., of those
  // that it looked at.
  const std::vector<Index>& changed() const { return triangles_; }
  uint32_t worst_sample(std::size_t rank);

 private:
  struct Face {
    std::size_t begin, end;         // its posts, a multiple of the lanes
    std::array<uint32_t, 3> mover;  // of each corner
    float excess;
    float slope[3];  // of the excess, by a step of each corner
    // The excess if a corner moved by a stride down or up; kUnknown.
    std::array<float, 2> shifted[3];
  };
  struct Mover {
    int32_t shift;
    bool is_inner;                                       // all its triangles are
    std::vector<std::pair<uint32_t, uint32_t>> corners;  // face, number of the corner
  };
  struct Step {
    std::size_t mover;
    int32_t shift;
  };

  void begin(const std::vector<Index>& vertices);
  bool add_hopeful(const std::vector<Index>& triangles);
  void find_triangles(const std::vector<Index>& vertices);
  void sort_in(Index triangle);
  float excess_under(Vertex a, Vertex b, Vertex c) const;
  void assess(Face& face) const;
  bool descend();
  void settle();
  void keep_changed();
  bool moves(const Face& face) const;
  bool has_moved() const;
  void go_back();
  void add_face(Index triangle);
  void add_posts(const std::array<Vertex, 3>& corner);
  std::size_t position_of(Index triangle, std::size_t post) const;
  void reserve(std::size_t posts);
  float excess_of(const Face& face, uint32_t corner, int32_t shift) const;
  double excess() const;
  Step best_step();
  double change_of(const Mover& mover, bool up);
  void move(Mover& mover, int32_t shift);
  int32_t step_to_source(const Mover& mover) const;

  const Surface& surface_;
  std::vector<uint32_t> mover_;  // by vertex of the surface
  std::vector<uint32_t> met_;    // by triangle of the surface: the last call that met it
  uint32_t call_ = 0;
  float hopeless_ = 0;      // excess with which a call gives up
  float first_excess_ = 0;  // before heights change
  std::size_t inner_faces_ = 0;
  int32_t stride_ = 1;
  int32_t preferred_ = 0;

  // Triangles between vertices but for the new ones, and others around them.
  std::vector<Index> inner_, outer_;
  std::vector<Index> triangles_;
  std::vector<Face> faces_;  // of these
  std::vector<Mover> movers_;
  std::size_t mover_count_ = 0;

  // By post of a face: how far the surface is above the middle of the bounds, how far the bounds
  // are from there, and what a step of each corner adds.
  std::vector<float> error_, radius_, weight_[3];
  std::size_t posts_ = 0;
};

}  // namespace microtin::fit

#endif
