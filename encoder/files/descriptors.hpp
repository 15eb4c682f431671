// SPDX-License-Identifier: MIT
// The descriptors that a process has: the standard ones, which may be closed, and how many more.
#ifndef MICROTIN_ENCODER_FILES_DESCRIPTORS_HPP
#define MICROTIN_ENCODER_FILES_DESCRIPTORS_HPP

#include "encoder/layers.hpp"

namespace microtin::files {

// Takes the numbers of those that are closed, so that no file that is opened later gets one of
// them. Reading from them and writing to them still fails as if they were closed, which tells
// them from /dev/null. Returns whether it could.
bool hold_closed_standard_files();

// Whether an error of writing (an errno) says that nobody reads: the descriptor is closed, or the
// other end of the pipe.
bool nobody_reads(int error);

// As many as the system allows this process, instead of the 1,024 that it usually begins with:
// each cell of a folder stays open, and each shard.
void allow_many_open_files();

}  // namespace microtin::files

#endif
