// SPDX-License-Identifier: MIT
// The secant method on logarithms, with slopes that terrain has.
#include "encoder/fit/bound_search.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace microtin::fit {
namespace {

constexpr double kUsualSlope = -1.2, kSteepest = -5, kFlattest = -0.5;
constexpr double kNearby = 0.01;  // logarithms of bounds too close to tell a slope
constexpr double kRange = 1e-6;
constexpr double kFarthest = 0.4;  // logarithm: beyond it the usual slope misleads
constexpr double kFarSlope = 4;    // except where sizes differ by more than this slope explains
constexpr double kMargin = 0.1;    // of the way between two ends: nearer to one tells little
constexpr int kHalving = 5;        // margins: bisection
constexpr double kFarOff = 0.1;    // of the logarithm of a size

}  // namespace

std::optional<Decimal> rounded(double bound) {
  char text[32];
  const char* const end =
      std::to_chars(text, text + sizeof text, bound, std::chars_format::scientific, 4).ptr;
  return parse_decimal(std::string_view(text, static_cast<std::size_t>(end - text)));
}

BoundSearch::BoundSearch(Decimal largest, double guess, double limit)
    : largest_(largest),
      lowest_(std::log(real(largest) * kRange)),
      highest_(std::log(real(largest))),
      guess_(std::clamp(std::log(guess), lowest_, highest_)),
      limit_(std::log(limit)),
      slope_(kUsualSlope) {}

Decimal BoundSearch::bound_for(double size) const {
  const double by_line = last_ ? beyond_last(size) : guess_;
  const double wanted = too_large_ && fitting_ ? between_ends(size) : by_line;
  const double bound = std::clamp(wanted, lowest_, highest_);
  if (bound >= highest_) return largest_;
  return std::min(rounded(std::exp(bound)).value_or(largest_), largest_,
                  [](Decimal a, Decimal b) { return !(b <= a); });
}

double BoundSearch::beyond_last(double size) const {
  const double ratio = std::log(size) - last_->size, way = ratio / slope_;
  if (slope_known_) return last_->bound + way;
  const double farthest = std::max(kFarthest, std::abs(ratio) / kFarSlope);
  return last_->bound + std::clamp(way, -farthest, farthest);
}

double BoundSearch::between_ends(double size) const {
  const double way = (std::log(size) - too_large_->size) / (fitting_->size - too_large_->size);
  const bool far_off = on_one_side_ > 1 && std::abs(last_->size - std::log(size)) > kFarOff;
  const double margin =
      kMargin * (far_off ? kHalving : std::min(std::max(on_one_side_, 1), kHalving));
  return too_large_->bound +
         std::clamp(way, margin, 1 - margin) * (fitting_->bound - too_large_->bound);
}

void BoundSearch::add(Decimal bound, std::optional<double> size) {
  const double at = std::log(real(bound));
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
    slope_known_ = true;
  }
  const bool same_side = last_ && (trial.size > limit_) == (last_->size > limit_);
  on_one_side_ = same_side ? on_one_side_ + 1 : 1;
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
  on_one_side_ = 0;
}

}  // namespace microtin::fit
