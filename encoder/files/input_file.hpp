// SPDX-License-Identifier: MIT
// Whole files as input.
#ifndef MICROTIN_ENCODER_FILES_INPUT_FILE_HPP
#define MICROTIN_ENCODER_FILES_INPUT_FILE_HPP

#include <string>

#include "encoder/layers.hpp"

namespace microtin::files {

// The bytes of a file, or of standard input for "-". Throws Error naming the file.
std::string read_file(const std::string& path);

}  // namespace microtin::files

#endif
