// SPDX-License-Identifier: MIT
// The descriptors that a process has: the standard ones, which may be closed, and how many more.
#include "encoder/files/descriptors.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>

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

bool nobody_reads(int error) {
  return error == EBADF || error == EPIPE;
}

void allow_many_open_files() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);  // where it fails, opening tells
}

}  // namespace microtin::files
