// SPDX-License-Identifier: MIT
// Fewer vertices for the same bounds.
#ifndef MICROTIN_ENCODER_FIT_DECIMATION_HPP
#define MICROTIN_ENCODER_FIT_DECIMATION_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <vector>

#include "encoder/base/work.hpp"
#include "encoder/fit/attempts.hpp"
#include "encoder/fit/surface.hpp"
#include "encoder/layers.hpp"

namespace microtin::fit {

// A local search: attempts at one vertex after the other, on several threads.
//
// The vertices wait in queues, which lie in different parts of the terrain. Each thread tries the
// next vertices of a queue on a copy of the surface, and takes its changes back. Then the changes
// that succeeded are applied to all copies, queue by queue. A change that depends on what an
// earlier queue changed is tried again instead. So the result is the same for any number of
// threads.
class Decimation {
 public:
  // The surface keeps its bounds. Both must outlive this.
  Decimation(Surface& surface, Team& team);

  // Tries every vertex around which something has changed since it was tried last. Returns how many
  // vertices fewer there are.
  std::size_t remove_vertices(const Progress& progress);
  // `done`: how much of the search is over, 0 .. 1.
  std::size_t remove_and_move_vertices(double done, const Progress& progress);

  // Removes a vertex that is not fixed, if its neighbours keep all bounds then. Says whether they
  // do.
  bool remove_vertex(Index v);

  // What `centre` and `add_vertices` bring nearer zero: the mean error, in steps.
  void aim(double mean);

  // Removes vertices, or moves them to posts whose places cost no more and which are at most so
  // near, along x and y together. Tries every vertex once, until the mean is zero.
  void centre(int near, const Progress& progress);

  // Adds at most this many vertices to large triangles, those first that help most. There are never
  // more vertices than at first.
  void add_vertices(std::size_t most);

  // Lets every vertex be tried again.
  void forget() { stale_.assign(stale_.size(), false); }

 private:
  // What one thread works on.
  struct Worker {
    Surface& surface;
    Attempts attempts;
    std::size_t edits;  // how many of edits_ the surface has
  };
  // Vertices that are tried one after the other.
  struct Queue {
    const Index* next;
    const Index* end;
  };
  using Attempt = std::function<bool(Attempts&, Index)>;
  using Decision = std::function<bool(const Outcome&)>;

  void begin_pass();
  void end_pass();
  Worker& up_to_date(std::size_t worker);
  void update_all();
  std::vector<Index> order_of_attempts();
  static std::vector<Queue> queues_of(const std::vector<Index>& order);
  static double part_left(const std::vector<Queue>& queues, std::size_t all);
  std::size_t try_each(const Progress& progress, const Attempt& attempt, const Decision& is_wanted);
  std::vector<Outcome> outcomes_in(const Queue& queue, std::size_t worker, const Attempt& attempt);
  std::size_t keep_some(const std::vector<std::vector<Outcome>>& outcomes,
                        std::vector<Queue>& queues, const Decision& is_wanted);
  void try_again_near(const Outcome& outcome);
  std::vector<std::array<Index, 3>> large_triangles() const;
  std::vector<Attempts::Addition> additions();
  int32_t direction() const { return rise_ < 0 ? -1 : 1; }
  bool has_reached_mean() const { return preferred_ * rise_ <= 0; }
  double even_part() const;

  Surface& surface_;
  Team& team_;
  std::deque<Surface> copies_;
  std::deque<Worker> workers_;      // the first has surface_, the others have copies of it
  std::vector<Edits::Edit> edits_;  // that some copies may still lack
  uint32_t passes_ = 0;

  int64_t rise_ = 0;         // of the volume, which brings the mean error to zero
  std::vector<bool> stale_;  // by vertex: nothing has changed there since it was tried
  double cheapness_ = 0;     // how likely an odd coordinate is replaced by an even one
  int32_t preferred_ = 0;    // direction of heights
  RandomNumbers random_{0};
};

}  // namespace microtin::fit

#endif
