// SPDX-License-Identifier: MIT
#include "encoder/files/open_files.hpp"

#include <sys/resource.h>

namespace microtin::files {

void allow_many_open_files() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);  // where it fails, opening tells
}

}  // namespace microtin::files
