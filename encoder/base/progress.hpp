// SPDX-License-Identifier: MIT
// Long pieces of work: on all processors, and how far they have come.
#ifndef MICROTIN_ENCODER_BASE_PROGRESS_HPP
#define MICROTIN_ENCODER_BASE_PROGRESS_HPP

#include <algorithm>
#include <cstddef>
#include <functional>
#include <mutex>
#include <numeric>
#include <utility>
#include <vector>

#include "encoder/base/team.hpp"
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

// Calls work(i) for every i < count, in any order, on as many threads as there are processors.
// Exceptions are handled as those of Team::for_each.
template <class Work>
void for_each_parallel(std::size_t count, const Work& work) {
  Team team(std::min(processors(), count));
  team.for_each(count, [&](std::size_t i, std::size_t) { work(i); });
}

// Progress of pieces of equal size, each of which reports its own, from any thread.
class SharedProgress {
 public:
  SharedProgress(Progress progress, std::size_t pieces)
      : progress_(std::move(progress)), done_(pieces) {}

  // Must not outlive this.
  Progress of(std::size_t piece) {
    return Progress([this, piece](double done) {
      const std::lock_guard<std::mutex> lock(mutex_);
      done_[piece] = done;
      progress_.at(std::accumulate(done_.begin(), done_.end(), 0.0) /
                   static_cast<double>(done_.size()));
    });
  }

 private:
  std::mutex mutex_;
  Progress progress_;
  std::vector<double> done_;
};

// Progress by pieces, which may be done by several threads.
class CountedProgress {
 public:
  CountedProgress(Progress progress, std::size_t pieces)
      : progress_(std::move(progress)), pieces_(pieces) {}

  void add_one() {
    const std::lock_guard<std::mutex> lock(mutex_);
    progress_.at(static_cast<double>(++done_) / static_cast<double>(pieces_));
  }

 private:
  std::mutex mutex_;
  Progress progress_;
  std::size_t pieces_, done_ = 0;
};

}  // namespace microtin::base

#endif
