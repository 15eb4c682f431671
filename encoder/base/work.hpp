// SPDX-License-Identifier: MIT
// Long pieces of work: threads that share them, and how far they have come.
#ifndef MICROTIN_ENCODER_BASE_WORK_HPP
#define MICROTIN_ENCODER_BASE_WORK_HPP

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <numeric>
#include <thread>
#include <utility>
#include <vector>

#include "encoder/layers.hpp"

namespace microtin::base {

// How many threads the machine runs at once.
inline std::size_t processors() {
  return std::max<std::size_t>(std::thread::hardware_concurrency(), 1);
}

// One thread at a time calls for_each.
class Team {
 public:
  // The calling thread is one of them. There are fewer if the system has no more.
  explicit Team(std::size_t threads);
  ~Team();
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  std::size_t size() const { return threads_.size() + 1; }

  // Calls work(i, worker) for every i < count, in any order. worker < size() names the thread.
  // After an exception no further piece is begun; that of the smallest piece that failed is thrown.
  void for_each(std::size_t count, const std::function<void(std::size_t, std::size_t)>& work);

 private:
  void wait_for_work(std::size_t worker);
  void share_work(std::size_t worker);
  template <class Condition>
  void wait_until(const Condition& holds);
  template <class Change>
  void change(const Change& change);

  std::vector<std::thread> threads_;
  std::mutex mutex_;  // of what others wait for: rounds_, busy_, ends_
  std::condition_variable changed_;
  std::atomic<uint64_t> rounds_{0};
  std::atomic<std::size_t> busy_{0};  // threads that work besides the calling one
  std::atomic<bool> ends_{false};

  const std::function<void(std::size_t, std::size_t)>* work_ = nullptr;
  std::size_t count_ = 0;
  std::atomic<std::size_t> next_{0};
  std::mutex error_mutex_;
  std::exception_ptr error_;
  std::size_t failed_ = 0;  // the smallest piece that did
};

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
