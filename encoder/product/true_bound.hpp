// SPDX-License-Identifier: MIT
// What a surface must do better so that points keep a bound where they truly lie.
#ifndef MICROTIN_ENCODER_PRODUCT_TRUE_BOUND_HPP
#define MICROTIN_ENCODER_PRODUCT_TRUE_BOUND_HPP

#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "encoder/export/queries.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/lattice_choice.hpp"
#include "encoder/verify/verify.hpp"

namespace microtin::product {

// Collects narrower limits for the heights at places near which points miss the bound; where a
// place had such limits in vain, limits at all places around the point.
class TrueBound {
 public:
  // The options have a bound. The surface must outlive it.
  TrueBound(const LatticeOptions& options, const SampledSurface& surface);

  // A point's place on the lattice, where it truly lies, its bound, and how far the surface is
  // above it there.
  void see(const RealPlace& nearest, const RealPlace& exact, double bound, double above);

  uint64_t missed() const { return missed_; }

  // Adds to what was collected before.
  void add_to(std::vector<Tightening>& tightenings);

 private:
  Tightening& limits_at(Point place);
  struct Range {
    double below, above;  // of the surface, from a point
  };
  void surround(const RealPlace& exact, int32_t height, Range allowed, double above);
  int32_t moved(int32_t height, double by) const;

  bool never_below_;
  double step_;
  const SampledSurface& surface_;
  std::set<std::pair<int64_t, int64_t>> before_;  // places that had narrower limits already
  std::map<std::pair<int64_t, int64_t>, Tightening> limits_;
  uint64_t missed_ = 0;
};

// Within what a surface is fitted that missed a bound by its error at true places: less by a tenth
// and twice the miss, but at least half of the bound.
Decimal narrower(Decimal bound, Decimal error);

}  // namespace microtin::product

#endif
