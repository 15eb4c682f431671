// SPDX-License-Identifier: MIT
// Notes: what headers of streams and packs say beside the terrain (format-stream.md, section 4).
#ifndef MICROTIN_ENCODER_STREAM_NOTES_HPP
#define MICROTIN_ENCODER_STREAM_NOTES_HPP

#include <cstdint>
#include <vector>

#include "encoder/exact/metadata.hpp"
#include "encoder/layers.hpp"

namespace microtin::stream {

// The notes that say something. Throws Error if they are too long.
std::vector<uint8_t> write_notes(const Metadata& metadata);

// The placement must be known. Of several notes of a type the first counts; unknown types are
// skipped, and so is what follows the known content of a note. Throws Error if they are malformed.
void read_notes(const uint8_t* begin, const uint8_t* end, Metadata& metadata);

}  // namespace microtin::stream

#endif
