// SPDX-License-Identifier: MIT
// Fewer vertices for the same bounds.
#ifndef MICROTIN_ENCODER_FIT_DECIMATION_HPP
#define MICROTIN_ENCODER_FIT_DECIMATION_HPP

#include <cstdint>
#include <vector>

#include "encoder/base/progress.hpp"
#include "encoder/fit/edits.hpp"
#include "encoder/fit/height_fit.hpp"
#include "encoder/fit/surface.hpp"
#include "encoder/layers.hpp"

namespace microtin::fit {

// A local search. A vertex is removed if its neighbours find heights that keep all bounds around.
// If not, it may move to a post where the bound is missed, and each of its new neighbours
// is tried; if none of them can go, it stays there nevertheless, so that the search does not get
// stuck.
class Decimation {
 public:
  // The surface keeps its bounds and must outlive this.
  explicit Decimation(Surface& surface);

  // Tries every vertex around which something has changed since it was tried last, in an order
  // that looks random. Returns how many vertices fewer there are.
  std::size_t remove_vertices(const Progress& progress);
  std::size_t remove_and_move_vertices(const Progress& progress);

  // Lets every vertex be tried again.
  void forget() { stale_.assign(stale_.size(), false); }

 private:
  template <class Try>
  std::size_t try_each(const Progress& progress, const Try& attempt);
  bool try_removal(Index v);
  bool try_move(Index v);
  bool fit(const std::vector<Index>& vertices);
  std::vector<Index> ring(Index v) const;
  void note_changes();
  std::size_t random_below(std::size_t limit);

  Surface& surface_;
  Edits edits_;
  HeightFit fit_;
  std::vector<Index> fitted_;  // by the attempt in hand
  std::vector<bool> stale_;    // by vertex: nothing has changed there since it was tried
  uint64_t random_ = 0;
};

}  // namespace microtin::fit

#endif
