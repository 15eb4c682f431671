// SPDX-License-Identifier: MIT
// Narrows limits by what points miss the bound by, and a little more. Where a point lies in a
// sliver along the hull that does not help: limits on both sides of it make the sliver go.
#include "encoder/product/true_bound.hpp"

#include <algorithm>
#include <cmath>

namespace microtin::product {

TrueBound::TrueBound(const LatticeOptions& options, const SampledSurface& surface)
    : never_below_(options.never_below), step_(step_of(surface.placement.z)), surface_(surface) {
  for (const Tightening& old : options.tightenings) before_.emplace(old.place.x, old.place.y);
}

Tightening& TrueBound::limits_at(Point place) {
  const Tightening all{place, INT32_MIN, INT32_MAX};
  return limits_.try_emplace({place.x, place.y}, all).first->second;
}

void TrueBound::see(const RealPlace& nearest, const RealPlace& exact, double bound, double above) {
  const Range allowed{never_below_ && std::isfinite(bound) ? 0 : -bound, bound};
  if (above >= allowed.below && above <= allowed.above) return;
  ++missed_;
  const ExactAnswer known = surface_.height_at(nearest);
  if (known.kind != MICROTIN_QUERY_OK) return;
  const int32_t here = fixed_height(known.height);
  const Point place{static_cast<uint16_t>(nearest.x), static_cast<uint16_t>(nearest.y)};
  constexpr double kWider = 1.25;  // the surface around will be another
  Tightening& limits = limits_at(place);
  if (above > allowed.above) {
    limits.highest = std::min(limits.highest, moved(here, kWider * (allowed.above - above)));
  } else {
    limits.lowest = std::max(limits.lowest, moved(here, kWider * (allowed.below - above)));
  }
  if (before_.count({place.x, place.y}) == 0) return;
  const ExactAnswer there = surface_.height_at(exact);
  surround(exact, there.kind == MICROTIN_QUERY_OK ? fixed_height(there.height) : here, allowed,
           above);
}

// A point's limits at all places around it.
void TrueBound::surround(const RealPlace& exact, int32_t height, Range allowed, double above) {
  const double margin = (allowed.above - allowed.below) / 16;  // the surface may bend between them
  for (const int64_t x : {exact.x, exact.x + (exact.x_part != 0 ? 1 : 0)}) {
    for (const int64_t y : {exact.y, exact.y + (exact.y_part != 0 ? 1 : 0)}) {
      if (x < 0 || y < 0 || x > kLatticeMax || y > kLatticeMax) continue;
      Tightening& limits = limits_at({static_cast<uint16_t>(x), static_cast<uint16_t>(y)});
      limits.lowest = std::max(limits.lowest, moved(height, allowed.below + margin - above));
      limits.highest = std::min(limits.highest, moved(height, allowed.above - margin - above));
    }
  }
}

void TrueBound::add_to(std::vector<Tightening>& tightenings) {
  for (const Tightening& old : tightenings) {
    Tightening& limits = limits_.try_emplace({old.place.x, old.place.y}, old).first->second;
    limits.lowest = std::max(limits.lowest, old.lowest);
    limits.highest = std::min(limits.highest, old.highest);
  }
  tightenings.clear();
  for (const auto& entry : limits_) tightenings.push_back(entry.second);
}

int32_t TrueBound::moved(int32_t height, double by) const {
  const double moved = height + by / step_ * 65536;
  return static_cast<int32_t>(std::clamp<double>(moved, INT32_MIN, INT32_MAX));
}

Decimal narrower(Decimal bound, Decimal error) {
  const Wide all = mantissa_at(bound, kMaxDecimals);
  const Wide missed = std::max<Wide>(mantissa_at(error, kMaxDecimals) - all, 0);
  return make_decimal(std::max(all - all / 10 - 2 * missed, all / 2), kMaxDecimals);
}

}  // namespace microtin::product
