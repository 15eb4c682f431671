// SPDX-License-Identifier: MIT
// Draws the bar, at most ten times a second.
#include "encoder/cli/progress.hpp"

#include <cstdio>
#include <string>

#include "encoder/files/descriptors.hpp"

namespace microtin::cli {

ProgressBar::ProgressBar() : on_terminal_(errors_go_to_terminal()) {}

ProgressBar::~ProgressBar() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

Progress ProgressBar::progress() {
  if (!on_terminal_) return {};
  return Progress([this](double done) { draw(done); });
}

void ProgressBar::draw(double done) {
  constexpr std::size_t kWidth = 40;
  constexpr std::chrono::milliseconds kInterval(100);
  constexpr std::chrono::seconds kQuiet(1);
  const Clock::time_point now = Clock::now();
  if (now - last_ < kInterval || now - start_ < kQuiet || done <= 0) return;
  last_ = now;
  drawn_ = true;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const auto filled = static_cast<std::size_t>(done * kWidth);
  const std::string bar = std::string(filled, '#') + std::string(kWidth - filled, '.');
  std::fprintf(stderr, "\r[%s] %3.0f %%, %.0f s left \033[K", bar.c_str(), 100 * done,
               elapsed / done - elapsed);
}

}  // namespace microtin::cli
