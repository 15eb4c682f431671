// SPDX-License-Identifier: MIT
// A list of temporary files that a signal handler removes.
#include "encoder/files/leftovers.hpp"

#include <unistd.h>

#include <atomic>
#include <cstring>
#include <mutex>

namespace microtin::files {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU};
constexpr std::size_t kSlots = 8, kLongest = 4096;

// A handler may read nothing else: fixed memory, each flag set last and cleared first.
struct Slot {
  volatile sig_atomic_t used;
  char path[kLongest];
};

Slot slots[kSlots];
std::mutex mutex;  // of who takes slots and gives them back

extern "C" void remove_and_die(int signal) {
  for (const Slot& slot : slots) {
    if (slot.used != 0) unlink(slot.path);
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);  // it is delivered when this returns
}

sigset_t signal_set() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : kSignals) sigaddset(&set, signal);
  return set;
}

}  // namespace

void remove_leftovers_on_signals() {
  for (const int signal : kSignals) {
    struct sigaction action {};
    if (sigaction(signal, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = remove_and_die;
    action.sa_mask = signal_set();
    sigaction(signal, &action, nullptr);
  }
}

SignalsHeld::SignalsHeld() : before_() {
  const sigset_t set = signal_set();
  pthread_sigmask(SIG_BLOCK, &set, &before_);
}

SignalsHeld::~SignalsHeld() {
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

Leftover::Leftover(const std::string& path) : slot_(0) {
  const std::lock_guard<std::mutex> lock(mutex);
  while (slot_ < kSlots && slots[slot_].used != 0) ++slot_;
  if (slot_ == kSlots || path.size() >= kLongest) {
    slot_ = kSlots;
    return;
  }
  std::memcpy(slots[slot_].path, path.c_str(), path.size() + 1);
  std::atomic_signal_fence(std::memory_order_seq_cst);
  slots[slot_].used = 1;
}

Leftover::~Leftover() {
  const std::lock_guard<std::mutex> lock(mutex);
  if (slot_ != kSlots) slots[slot_].used = 0;
}

}  // namespace microtin::files
