// SPDX-License-Identifier: MIT
// Signals of POSIX remove the leftovers.
#include <unistd.h>

#include "encoder/files/leftovers.hpp"

namespace microtin::files {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU};

extern "C" void remove_and_die(int signal) {
  for_each_leftover([](const char* path) { unlink(path); });
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

}  // namespace microtin::files
