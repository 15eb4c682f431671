// SPDX-License-Identifier: MIT
// Heights that cost few bits, within their bounds, and mean errors near zero: of all posts, and of
// each large flat part of the source. Each has a source of its own.
#ifndef MICROTIN_ENCODER_FIT_HEIGHT_CHOICE_HPP
#define MICROTIN_ENCODER_FIT_HEIGHT_CHOICE_HPP

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/base/work.hpp"
#include "encoder/fit/surface.hpp"
#include "encoder/layers.hpp"
#include "shared/height_coding.hpp"

namespace microtin::fit {

// The sum of errors is linear in the heights of vertices, so a change of one tells at once what
// becomes of every mean. Where bounds are not around the source's heights (--never-below) no mean
// is looked at: errors lie on one side there.
class Balance {
 public:
  // weight: what a mean that is off by a radius is worth, in bits a vertex.
  // Linear in posts, where no cell of their index holds many. Of the surface only heights may
  // change then, and `move` reports each change.
  Balance(const Surface& surface, double weight);

  // What a change of a height makes of the means, in bits: below 0 where they come nearer to zero.
  double price(Index v, int32_t steps) const;
  void move(Index v, int32_t steps);

  // The mean of all posts' errors, in steps, and whether it is near enough to zero as it is.
  double mean() const { return parts_.empty() ? 0 : parts_[0].sum / parts_[0].posts; }
  bool is_centred() const;

  // Whether every mean is near zero, and if not, how much that is worth.
  bool is_kept() const;
  void weigh_more() { weight_ *= 2; }

 private:
  struct Part {
    double sum;        // of errors, in steps
    double posts;      // how many there are
    double tolerance;  // of the mean, in steps
    double vertices;   // that it depends on
  };
  struct Share {
    double weight;  // what a step of the vertex adds to the part's sum
    uint32_t part;
    uint32_t next;  // of the vertex; kNone
  };
  static constexpr uint32_t kNone = ~uint32_t{0};

  // By sample: its flat part, or 0.
  std::vector<uint8_t> find_parts(const Surface& surface);
  void add_face(const Surface& surface, Index triangle, const std::vector<uint8_t>& part_of,
                std::vector<bool>& met);
  void add_error(uint32_t part, double error, const Index* corner, const double* weight);
  double excess(const Part& part, double change) const;

  std::vector<Part> parts_;  // the first: all posts
  std::vector<Share> shares_;
  std::vector<uint32_t> first_;  // by vertex: its first share, or kNone
  double radius_;                // of the bounds, on average
  double weight_;                // bits a vertex, if a mean is off by a radius
};

// Knows in which order the vertices of a surface are sent and which neighbours predict each.
class HeightChoice {
 public:
  // The surface keeps its bounds and must outlive this, as must the team; only its heights may
  // change meanwhile. degree: as for breadth_first_order; weight: as for Balance.
  HeightChoice(Surface& surface, Team& team, uint32_t degree, double weight);

  // Gives each vertex in turn the allowed height that makes it and those that it predicts cheapest,
  // where small errors, the source's height on flat ground and means near zero are worth some bits.
  void pass();

  // Such a pass in which means are worth twice as much as before: what costs least is changed
  // first.
  void balance();

  // Whether means are near zero.
  bool is_balanced() const { return balance_.is_kept(); }
  bool is_centred() const { return balance_.is_centred(); }
  double mean_error() const { return balance_.mean(); }

 private:
  // Numbers of vertices here are places in the order of sending.
  void find_rings(uint32_t degree);
  void find_dependents();
  HeightPrediction predict(Index i) const;
  void learn_costs();
  float cost(Index i) const;
  float cost_at(Index i, int32_t height, float most);
  void find_levels();
  struct Goal {
    double height, weight;
  };
  Goal goal_of(Index i, const Surface::Interval& allowed) const;
  static float price(const Goal& goal, int32_t height);
  void choose(Index i);
  int32_t cheapest(Index i, const Surface::Interval& allowed);
  void set_height(Index i, int32_t height);
  void find_allowed_heights();
  const Surface::Interval& allowed_heights(Index v);

  Surface& surface_;
  Team& team_;
  Balance balance_;
  std::vector<Index> vertex_;  // of the surface
  std::vector<Point> place_;
  std::vector<int16_t> z_;
  std::vector<Residual> residual_;
  Mesh mesh_{};  // the places and heights, without triangles
  std::vector<uint32_t> ring_start_, dependent_start_;
  std::vector<Index> rings_, dependents_;
  std::array<std::array<float, kMagnitudeBits + 1>, kScales> bits_{};

  std::vector<std::optional<double>> level_;  // the source's height where it is flat, in steps
  double radius_;                             // of the bounds, on average
  double vertices_per_radius_ = 0;            // for each post, and squared

  // By vertex of the surface: what it may be while nothing around changes.
  std::vector<std::optional<Surface::Interval>> allowed_;
};

}  // namespace microtin::fit

#endif
