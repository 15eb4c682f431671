// SPDX-License-Identifier: MIT
// What the names of files lead to.
#ifndef MICROTIN_ENCODER_FILES_FILE_TARGET_HPP
#define MICROTIN_ENCODER_FILES_FILE_TARGET_HPP

#include <optional>
#include <string>
#include <vector>

#include "encoder/layers.hpp"

namespace microtin::files {

// The descriptor of this process that is meant by a name such as /dev/stdout, /dev/fd/3 or
// /proc/self/fd/1, or by a link to one; 1 for "-". Nothing for other names. Throws Error if links
// lead round in a circle.
std::optional<int> descriptor_named(const std::string& path);

// The file whose place an output of this name takes: the name behind all links, also where there
// is no file yet. Nothing if it is a descriptor, a device or a pipe, which are written directly.
// Throws Error for folders, too.
std::optional<std::string> replaced_by(const std::string& path);

// Throws Error if the output, or standard output, which takes reports, is the file of one of the
// inputs by whatever name. "-" is standard input or output.
void refuse_overwriting(const std::vector<std::string>& inputs, const std::string& output);

}  // namespace microtin::files

#endif
