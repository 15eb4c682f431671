// SPDX-License-Identifier: MIT
// Fewer vertices for the same bounds.
#ifndef MICROTIN_ENCODER_FIT_DECIMATION_HPP
#define MICROTIN_ENCODER_FIT_DECIMATION_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "encoder/base/progress.hpp"
#include "encoder/fit/height_fit.hpp"
#include "encoder/fit/surface.hpp"
#include "encoder/layers.hpp"

namespace microtin::fit {

// A local search. A vertex is removed if its neighbours find heights that keep all bounds around.
// If not, it may move to a post next to it whose place costs fewer bits, to a random one near it,
// or to one where the bound is missed, and then each of its new neighbours is tried; if none of
// them can go, it stays there nevertheless, so that the search does not get stuck. Places are cheap
// where both coordinates are multiples of two.
class Decimation {
 public:
  // The surface keeps its bounds and must outlive this.
  explicit Decimation(Surface& surface);

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
  // near, along x and y together. Of some of these posts it takes that which helps most. Tries
  // every vertex once, until the mean is zero.
  void centre(int near, const Progress& progress);

  // Adds at most this many vertices to large triangles, those first that help most. There are never
  // more vertices than at first.
  void add_vertices(std::size_t most);

  // Lets every vertex be tried again.
  void forget() { stale_.assign(stale_.size(), false); }

 private:
  // Where a vertex was removed.
  struct Hole {
    std::vector<Index> ring;  // its neighbours
    int64_t raised;           // what the surface's volume became larger by
  };
  // A vertex that could be added near another, and what that gains.
  struct Addition {
    int64_t gain;
    Vertex vertex;
    Index corner;
  };

  std::vector<Index> order_of_attempts();
  std::size_t try_each(const Progress& progress, const std::function<bool(Index)>& attempt);
  bool try_removal(Index v);
  bool try_move(Index v);
  bool try_towards_centre(Index v, int near);
  bool move_near(Vertex old, int near, const Hole& hole);
  std::vector<std::array<Index, 3>> large_triangles() const;
  std::vector<Addition> additions();
  std::optional<Addition> addition_in(const std::array<Index, 3>& corners);
  bool add(const Addition& addition);
  int32_t direction() const { return rise_ < 0 ? -1 : 1; }
  int64_t gain() const { return direction() * raised_; }
  bool try_cheaper_posts(Vertex old, const Hole& hole);
  bool try_near(Vertex old, const Hole& hole);
  bool try_post(Point to, Vertex old, const Hole& hole);
  bool place(Vertex vertex, const Hole& hole);
  bool insert(Vertex vertex, const Hole& hole);
  std::optional<Vertex> carried(Vertex old, int x, int y) const;
  uint16_t cheap(uint16_t coordinate);
  int16_t nearest_height(std::size_t post) const;
  double even_part() const;
  bool fit(const std::vector<Index>& vertices);
  std::vector<Index> ring(Index v) const;
  std::optional<Hole> remove(Index v);
  void keep_edits();
  std::size_t random_below(std::size_t limit);

  Surface& surface_;
  Edits edits_;
  HeightFit fit_;
  std::vector<Index> fitted_;  // by the attempt in hand
  int64_t raised_ = 0;         // by it: what the volume became larger by
  int64_t rise_ = 0;           // of the volume, which brings the mean error to zero
  std::vector<bool> stale_;    // by vertex: nothing has changed there since it was tried
  Index moved_ = 0;            // inserted last
  double cheapness_ = 0;       // how likely an odd coordinate is replaced by an even one
  uint64_t random_ = 0;
};

}  // namespace microtin::fit

#endif
