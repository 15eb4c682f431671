// SPDX-License-Identifier: MIT
// A bar on the terminal.
#ifndef MICROTIN_ENCODER_CLI_PROGRESS_HPP
#define MICROTIN_ENCODER_CLI_PROGRESS_HPP

#include <chrono>

#include "encoder/base/progress.hpp"
#include "encoder/layers.hpp"

namespace microtin::cli {

// Draws how far the work is and, after a second, how many seconds are left, on standard error if
// that is a terminal. Wipes it off at the end.
class ProgressBar {
 public:
  ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar();

  // Reports to the bar, which must outlive it.
  Progress progress();

 private:
  using Clock = std::chrono::steady_clock;

  void draw(double done);

  bool on_terminal_;
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now(), last_ = start_;
};

}  // namespace microtin::cli

#endif
