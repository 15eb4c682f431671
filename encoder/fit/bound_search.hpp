// SPDX-License-Identifier: MIT
// Which error bound takes how many bytes, or vertices, as learned from a few trials.
#ifndef MICROTIN_ENCODER_FIT_BOUND_SEARCH_HPP
#define MICROTIN_ENCODER_FIT_BOUND_SEARCH_HPP

#include <optional>

#include "encoder/exact/decimal.hpp"
#include "encoder/layers.hpp"

namespace microtin::fit {

// Sizes fall with a power of the bound: a straight line of logarithms, through the last two trials.
class BoundSearch {
 public:
  // Bounds lie between a millionth of `largest` and that. guess > 0: the first to be tried.
  BoundSearch(Decimal largest, double guess);

  // The bound, to four digits, that should take that size.
  Decimal bound_for(double size) const;

  // What a trial took; nothing if the bound was too small to be kept at all.
  void add(Decimal bound, std::optional<double> size);

 private:
  struct Trial {
    double bound, size;  // logarithms
  };

  Decimal largest_;
  double lowest_, highest_;  // logarithms of bounds
  double guess_;
  std::optional<Trial> last_;
  double slope_;
};

}  // namespace microtin::fit

#endif
