// SPDX-License-Identifier: MIT
// How far a long piece of work has come.
#ifndef MICROTIN_ENCODER_BASE_PROGRESS_HPP
#define MICROTIN_ENCODER_BASE_PROGRESS_HPP

#include <functional>
#include <utility>

#include "encoder/layers.hpp"

namespace microtin::base {

// Parts of the work are fractions of its time, estimated. Copies report to the same listener.
class Progress {
 public:
  Progress() = default;  // nobody listens
  explicit Progress(std::function<void(double done)> listener) : listener_(std::move(listener)) {}

  // That much of this work is done: 0 .. 1.
  void at(double done) const {
    if (listener_) listener_(from_ + (to_ - from_) * done);
  }

  // The part of this work from one fraction to another.
  Progress part(double from, double to) const {
    Progress part = *this;
    part.from_ = from_ + (to_ - from_) * from;
    part.to_ = from_ + (to_ - from_) * to;
    return part;
  }

 private:
  std::function<void(double)> listener_;
  double from_ = 0, to_ = 1;
};

}  // namespace microtin::base

#endif
