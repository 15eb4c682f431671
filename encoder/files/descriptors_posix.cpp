// SPDX-License-Identifier: MIT
// What a process gets from POSIX.
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

#include "encoder/files/descriptors.hpp"

namespace microtin::files {

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

}  // namespace microtin::files
