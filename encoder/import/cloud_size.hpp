// SPDX-License-Identifier: MIT
// How large a cloud is, before it is read.
#ifndef MICROTIN_ENCODER_IMPORT_CLOUD_SIZE_HPP
#define MICROTIN_ENCODER_IMPORT_CLOUD_SIZE_HPP

#include <cstdint>
#include <string>

#include "encoder/files/byte_reader.hpp"
#include "encoder/layers.hpp"

namespace microtin::importing {

// About how many points a file holds: what the header of a .las or .ply says, or as many lines as
// there are in a text if all are as long as its first. 0 of other files, and of those that cannot
// be read, which reading tells.
uint64_t points_expected(const std::string& path);

// How many points the header of a LAS file says there are. Throws Error if it is cut off.
uint64_t points_of_las(const ByteReader& file);

}  // namespace microtin::importing

#endif
