// SPDX-License-Identifier: MIT
// Mean errors: of all posts, and of each large flat part of the source.
#ifndef MICROTIN_ENCODER_FIT_BALANCE_HPP
#define MICROTIN_ENCODER_FIT_BALANCE_HPP

#include <cstdint>
#include <vector>

#include "encoder/fit/surface.hpp"
#include "encoder/layers.hpp"

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

}  // namespace microtin::fit

#endif
