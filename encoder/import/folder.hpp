// SPDX-License-Identifier: MIT
// Folders of terrain files.
#ifndef MICROTIN_ENCODER_IMPORT_FOLDER_HPP
#define MICROTIN_ENCODER_IMPORT_FOLDER_HPP

#include <string>
#include <vector>

#include "encoder/layers.hpp"

namespace microtin::importing {

// The files of a terrain: for a folder those in it, by name, of the suffix that most of its terrain
// files have. Throws Error if a folder holds none.
std::vector<std::string> files_in(const std::string& path);

// What people should know of a folder that holds terrain files of other suffixes, too; else empty.
std::string left_out_of(const std::string& path);

}  // namespace microtin::importing

#endif
