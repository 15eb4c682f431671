// SPDX-License-Identifier: MIT
// Which error bound takes how many bytes, or vertices, as learned from a few trials.
#ifndef MICROTIN_ENCODER_FIT_BOUND_SEARCH_HPP
#define MICROTIN_ENCODER_FIT_BOUND_SEARCH_HPP

#include <optional>

#include "encoder/exact/decimal.hpp"
#include "encoder/layers.hpp"

namespace microtin::fit {

// To five digits. Nothing if a decimal has no room for them.
std::optional<Decimal> rounded(double bound);

// Sizes fall with a power of the bound: a straight line of logarithms, through the last two trials
// or, once some were too large and others not, between the nearest two of these: the nearer to the
// middle the more trials ended on one side, as sizes may jump.
class BoundSearch {
 public:
  // Bounds lie between a millionth of `largest` and that. guess > 0: the first to be tried. limit:
  // the size that is allowed.
  BoundSearch(Decimal largest, double guess, double limit);

  // The bound, to five digits, that should take that size.
  Decimal bound_for(double size) const;

  // What a trial took; nothing if the bound was too small to be kept at all.
  void add(Decimal bound, std::optional<double> size);

  // Trials so far were rough: they tell of the line, but not which bounds are too small.
  void forget_ends();

 private:
  struct Trial {
    double bound, size;  // logarithms
  };

  double beyond_last(double size) const;
  double between_ends(double size) const;

  Decimal largest_;
  double lowest_, highest_;  // logarithms of bounds
  double guess_, limit_;     // logarithms
  std::optional<Trial> last_;
  std::optional<Trial> too_large_, fitting_;  // with the largest bound, and with the smallest
  int on_one_side_ = 0;                       // the last trials, of the limit
  double slope_;
  bool slope_known_ = false;  // not just usual
};

}  // namespace microtin::fit

#endif
