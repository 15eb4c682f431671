// SPDX-License-Identifier: MIT
// What a process gets from POSIX, and what its signals do.
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

#include "encoder/files/process.hpp"

namespace microtin::files {

// What a process gets from POSIX.

bool hold_closed_standard_files() {
  for (int number = STDIN_FILENO; number <= STDERR_FILENO; ++number) {
    if (fcntl(number, F_GETFD) >= 0 || errno != EBADF) continue;
    // Open for the opposite of what it is for. The lowest free number is this one.
    const int mode = number == STDIN_FILENO ? O_WRONLY : O_RDONLY;
    if (open("/dev/null", mode) != number) return false;
  }
  return true;
}

void make_signals_errors() {
  for (const int ignored : {SIGXFSZ, SIGPIPE}) std::signal(ignored, SIG_IGN);
}

bool nobody_reads(int error) {
  return error == EBADF || error == EPIPE;
}

void allow_many_open_files() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);  // if it fails, opening a file does
}

bool errors_go_to_terminal() {
  return isatty(STDERR_FILENO) != 0;
}

std::vector<std::string> program_arguments(int argc, const char* const* argv) {
  return {argv, argv + argc};
}

uint64_t machine_memory() {
  const long pages = sysconf(_SC_PHYS_PAGES), bytes = sysconf(_SC_PAGESIZE);
  if (pages < 0 || bytes < 0) return 0;
  return static_cast<uint64_t>(pages) * static_cast<uint64_t>(bytes);
}

// Signals of POSIX remove the leftovers.

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
