// SPDX-License-Identifier: MIT
// Long pieces of work: on all processors, and how far they have come.
#ifndef MICROTIN_ENCODER_BASE_PROGRESS_HPP
#define MICROTIN_ENCODER_BASE_PROGRESS_HPP

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

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
// After an exception no further piece is begun; that of the smallest piece that failed is thrown.
template <class Work>
void for_each_parallel(std::size_t count, const Work& work) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr error;
  std::size_t failed = count;
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        next = count;
        const std::lock_guard<std::mutex> lock(mutex);
        if (i < failed) error = std::current_exception();
        failed = std::min(failed, i);
      }
    }
  };
  const std::size_t wanted = std::max<std::size_t>(std::thread::hardware_concurrency(), 1);
  std::vector<std::thread> threads;
  try {
    while (threads.size() + 1 < std::min(wanted, count)) threads.emplace_back(run);
  } catch (...) {  // without memory for more, those that are there do it
  }
  run();
  for (std::thread& thread : threads) thread.join();
  if (error) std::rethrow_exception(error);
}

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
