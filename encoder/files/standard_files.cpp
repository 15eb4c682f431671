// SPDX-License-Identifier: MIT
// Opens the null device in place of standard files that are closed.
#include "encoder/files/standard_files.hpp"

#include <fcntl.h>
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

}  // namespace microtin::files
