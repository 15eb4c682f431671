// SPDX-License-Identifier: MIT
// Narrows limits by what points miss the bound by, and a little more.
#include "encoder/product/true_bound.hpp"

#include <algorithm>
#include <optional>
#include <string>

namespace microtin::product {

TrueBound::TrueBound(const LatticeOptions& options, const SampledSurface& surface)
    : above_(real(*options.max_error)),
      below_(options.never_below ? 0 : -above_),
      step_(step_of(surface.placement.z)),
      surface_(surface) {}

void TrueBound::see(int64_t x, int64_t y, double above) {
  if (above >= below_ && above <= above_) return;
  ++missed_;
  const std::optional<int32_t> here = surface_.height_at(256 * x, 256 * y);
  if (!here) return;
  const Tightening all{{static_cast<uint16_t>(x), static_cast<uint16_t>(y)}, INT32_MIN, INT32_MAX};
  Tightening& limits = limits_.try_emplace({x, y}, all).first->second;
  if (above > above_) {
    limits.highest = std::min(limits.highest, moved(*here, above_ - above));
  } else {
    limits.lowest = std::max(limits.lowest, moved(*here, below_ - above));
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

// A height moved by so much, and a quarter more: the surface around will be another.
int32_t TrueBound::moved(int32_t height, double by) const {
  constexpr double kMore = 1.25;
  const double moved = height + kMore * by / step_ * 65536;
  return static_cast<int32_t>(std::clamp<double>(moved, INT32_MIN, INT32_MAX));
}

Decimal narrower(Decimal bound, Decimal error) {
  const Wide all = mantissa_at(bound, kMaxDecimals);
  const Wide missed = std::max<Wide>(mantissa_at(error, kMaxDecimals) - all, 0);
  return make_decimal(std::max(all - all / 10 - 2 * missed, all / 2), kMaxDecimals);
}

}  // namespace microtin::product
