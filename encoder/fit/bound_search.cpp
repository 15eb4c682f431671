// SPDX-License-Identifier: MIT
// The secant method on logarithms, with slopes that terrain has.
#include "encoder/fit/bound_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace microtin::fit {
namespace {

constexpr double kUsualSlope = -1.2, kSteepest = -5, kFlattest = -0.5;
constexpr double kNearby = 0.01;  // logarithms of bounds too close to tell a slope
constexpr double kRange = 1e-6;
constexpr double kMargin = 0.1;  // of the way between two ends: nearer to one tells little

double value_of(Decimal d) {
  return static_cast<double>(d.mantissa) / std::pow(10.0, d.decimals);
}

}  // namespace

BoundSearch::BoundSearch(Decimal largest, double guess, double limit)
    : largest_(largest),
      lowest_(std::log(value_of(largest) * kRange)),
      highest_(std::log(value_of(largest))),
      guess_(std::clamp(std::log(guess), lowest_, highest_)),
      limit_(std::log(limit)),
      slope_(kUsualSlope) {}

Decimal BoundSearch::bound_for(double size) const {
  const double by_line = last_ ? last_->bound + (std::log(size) - last_->size) / slope_ : guess_;
  const double wanted = too_large_ && fitting_ ? between_ends(size) : by_line;
  const double bound = std::clamp(wanted, lowest_, highest_);
  if (bound >= highest_) return largest_;
  char text[32];
  std::snprintf(text, sizeof text, "%.4e", std::exp(bound));
  return std::min(parse_decimal(text).value_or(largest_), largest_,
                  [](Decimal a, Decimal b) { return !(b <= a); });
}

double BoundSearch::between_ends(double size) const {
  const double way = (std::log(size) - too_large_->size) / (fitting_->size - too_large_->size);
  return too_large_->bound +
         std::clamp(way, kMargin, 1 - kMargin) * (fitting_->bound - too_large_->bound);
}

void BoundSearch::add(Decimal bound, std::optional<double> size) {
  const double at = std::log(value_of(bound));
  if (!size) {  // larger ones only
    lowest_ = std::min(at + kNearby, highest_);
    guess_ = std::min(at + 1, highest_);
    last_.reset();
    return;
  }
  const Trial trial{at, std::log(std::max(*size, 1.0))};
  if (last_ && std::abs(trial.bound - last_->bound) > kNearby) {
    slope_ =
        std::clamp((trial.size - last_->size) / (trial.bound - last_->bound), kSteepest, kFlattest);
  }
  last_ = trial;
  if (trial.size > limit_) {
    if (!too_large_ || at > too_large_->bound) too_large_ = trial;
    if (fitting_ && fitting_->bound <= at) fitting_.reset();
  } else {
    if (!fitting_ || at < fitting_->bound) fitting_ = trial;
    if (too_large_ && too_large_->bound >= at) too_large_.reset();
  }
}

void BoundSearch::forget_ends() {
  too_large_.reset();
  fitting_.reset();
}

}  // namespace microtin::fit
