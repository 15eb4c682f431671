// SPDX-License-Identifier: MIT
// Whether water stays at its level.
#ifndef MICROTIN_ENCODER_VERIFY_WATER_GAUGE_HPP
#define MICROTIN_ENCODER_VERIFY_WATER_GAUGE_HPP

#include <cstdint>
#include <optional>

#include "encoder/exact/decimal.hpp"
#include "encoder/layers.hpp"
#include "encoder/verify/verify.hpp"

namespace microtin::verifying {

// Counts the posts at the water level where a terrain is not exactly there.
class WaterGauge {
 public:
  // Gauges a source whose heights have `decimals` decimals. Without a level it counts nothing.
  WaterGauge(int decimals, const std::optional<Decimal>& level);

  // The gauge must outlive it.
  PostVisitor visitor();

  uint64_t moved() const { return moved_; }

 private:
  std::optional<int64_t> number_;  // of the source, for the level
  uint64_t moved_ = 0;
};

}  // namespace microtin::verifying

#endif
