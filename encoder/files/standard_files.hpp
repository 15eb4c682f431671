// SPDX-License-Identifier: MIT
// Standard input, output and error, which the caller may have closed.
#ifndef MICROTIN_ENCODER_FILES_STANDARD_FILES_HPP
#define MICROTIN_ENCODER_FILES_STANDARD_FILES_HPP

#include "encoder/layers.hpp"

namespace microtin::files {

// Takes the numbers of those that are closed, so that no file that is opened later gets one of
// them. Reading from them and writing to them still fails as if they were closed, which tells
// them from /dev/null. Returns whether it could.
bool hold_closed_standard_files();

// Whether an error of writing (an errno) says that nobody reads: the descriptor is closed, or the
// other end of the pipe.
bool nobody_reads(int error);

}  // namespace microtin::files

#endif
