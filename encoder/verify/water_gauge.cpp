// SPDX-License-Identifier: MIT
// Counts posts of water that a terrain moves.
#include "encoder/verify/water_gauge.hpp"

namespace microtin::verifying {

WaterGauge::WaterGauge(int decimals, const std::optional<Decimal>& level)
    : number_(number_of(level, decimals)) {}

PostVisitor WaterGauge::visitor() {
  return [this](int64_t, int64_t, int64_t z, double above) {
    if (z == number_ && above != 0) ++moved_;
  };
}

}  // namespace microtin::verifying
