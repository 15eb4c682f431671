// SPDX-License-Identifier: MIT
// Threads wait for the next round of work: first awake, since it mostly comes soon, then asleep.
#include "encoder/base/work.hpp"

#include <utility>

namespace microtin::base {
namespace {

// Some ten microseconds: a round of the search takes many times as long.
constexpr int kLooks = 5000;

}  // namespace

Team::Team(std::size_t threads) {
  try {
    for (std::size_t worker = 1; worker < threads; ++worker) {
      threads_.emplace_back([this, worker] { wait_for_work(worker); });
    }
  } catch (...) {  // the system has no more: those that are there do it
  }
}

Team::~Team() {
  change([this] { ends_ = true; });
  for (std::thread& thread : threads_) thread.join();
}

template <class Condition>
void Team::wait_until(const Condition& holds) {
  for (int i = 0; i < kLooks; ++i) {
    if (holds()) return;
  }
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, holds);
}

template <class Change>
void Team::change(const Change& change) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    change();
  }
  changed_.notify_all();
}

void Team::wait_for_work(std::size_t worker) {
  for (uint64_t round = 1;; ++round) {
    wait_until([&] { return ends_ || rounds_ >= round; });
    if (ends_) return;
    share_work(worker);
    change([this] { --busy_; });
  }
}

void Team::share_work(std::size_t worker) {
  for (std::size_t i = next_++; i < count_; i = next_++) {
    try {
      (*work_)(i, worker);
    } catch (...) {
      next_ = count_;
      const std::lock_guard<std::mutex> lock(error_mutex_);
      if (!error_ || i < failed_) {
        error_ = std::current_exception();
        failed_ = i;
      }
    }
  }
}

void Team::for_each(std::size_t count, const std::function<void(std::size_t, std::size_t)>& work) {
  work_ = &work;
  count_ = count;
  next_ = 0;
  const bool is_shared = count > 1 && !threads_.empty();
  if (is_shared) {
    change([this] {
      busy_ = threads_.size();
      ++rounds_;
    });
  }
  share_work(0);
  if (is_shared) wait_until([this] { return busy_ == 0; });
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

}  // namespace microtin::base
