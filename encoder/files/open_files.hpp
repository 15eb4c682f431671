// SPDX-License-Identifier: MIT
// How many files may be open at once.
#ifndef MICROTIN_ENCODER_FILES_OPEN_FILES_HPP
#define MICROTIN_ENCODER_FILES_OPEN_FILES_HPP

#include "encoder/layers.hpp"

namespace microtin::files {

// As many as the system allows this process, instead of the 1,024 that it usually begins with:
// each cell of a folder stays open, and each shard.
void allow_many_open_files();

}  // namespace microtin::files

#endif
