// SPDX-License-Identifier: MIT
// Threads that share pieces of work, many times a second if need be.
#ifndef MICROTIN_ENCODER_BASE_TEAM_HPP
#define MICROTIN_ENCODER_BASE_TEAM_HPP

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
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

}  // namespace microtin::base

#endif
