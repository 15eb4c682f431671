// SPDX-License-Identifier: MIT
// A surface through some samples of a survey, refined by making the worst sample a vertex.
#ifndef MICROTIN_ENCODER_FIT_REFINEMENT_HPP
#define MICROTIN_ENCODER_FIT_REFINEMENT_HPP

#include <cstddef>
#include <cstdint>
#include <queue>
#include <vector>

#include "encoder/fit/error_model.hpp"
#include "encoder/fit/post_index.hpp"
#include "encoder/layers.hpp"
#include "encoder/stream/triangulation.hpp"
#include "encoder/terrain/survey.hpp"

namespace microtin::fit {

class Refinement {
 public:
  // Starts with the given samples as vertices; all others must lie within their hull. The survey
  // and the index of its samples must outlive this.
  Refinement(const Survey& survey, ErrorModel model, const PostIndex& posts,
             const std::vector<uint32_t>& corners);

  // Starts with a surface through samples, at its heights or the nearest that these allow.
  Refinement(const Survey& survey, ErrorModel model, const PostIndex& posts, const Tin& tin);

  // Inserts samples until none is violated or there are max_vertices; samples in void triangles are
  // inserted even then.
  void refine(std::size_t max_vertices);

  Tin tin() const;

 private:
  // How urgently a sample must become a vertex.
  struct Candidate {
    uint64_t urgency;  // 0: not at all; from kUncovered on: only void triangles hold it
    uint32_t sample;

    bool operator==(const Candidate& other) const {
      return urgency == other.urgency && sample == other.sample;
    }
    // Smaller samples first among equals: the result depends on the survey alone.
    bool operator<(const Candidate& other) const {
      return urgency != other.urgency ? urgency < other.urgency : sample > other.sample;
    }
  };
  // Violations of heights and squared distances are smaller.
  static constexpr uint64_t kOnRim = uint64_t{1} << 40, kUncovered = uint64_t{1} << 41;

  struct Entry {
    Candidate candidate;
    Index triangle;

    bool operator<(const Entry& other) const {
      return candidate == other.candidate ? triangle > other.triangle : candidate < other.candidate;
    }
  };

  // Vertices at these places are still to be added, in their order.
  Refinement(const Survey& survey, ErrorModel model, const PostIndex& posts,
             const std::vector<Point>& places);

  void add_vertex(uint32_t sample, int16_t height);
  void begin();
  void find_rims();
  void insert(uint32_t sample, Index triangle);
  void set_triangles();
  template <class Visit>
  void visit_under(const PostIndex& posts, Index triangle, const Visit& visit) const;
  void look_for_voids(Index triangle);
  void assess(Index triangle);
  Candidate worst_within(Index triangle) const;
  Candidate worst_in_void(Index triangle) const;
  bool is_real(Index triangle) const;
  bool on_covered_edge(Index triangle, Point p) const;
  uint64_t uncovered_urgency(Index triangle, uint32_t sample) const;
  Vertex vertex(Index v) const;

  const Survey& survey_;
  ErrorModel model_;
  const PostIndex& posts_;  // the samples
  PostIndex void_posts_;
  Triangulation triangulation_;
  std::vector<int16_t> heights_;  // of vertices
  std::vector<bool> is_vertex_;   // by sample
  std::vector<bool> on_rim_;      // by sample: a neighbouring post is void
  std::vector<bool> void_;        // by triangle: a void post lies in it or on its border

  std::vector<Candidate> worst_;  // by triangle
  std::priority_queue<Entry> queue_;
};

}  // namespace microtin::fit

#endif
