// SPDX-License-Identifier: MIT
// Headers of streams, with all their notes.
#ifndef MICROTIN_ENCODER_STREAM_HEADER_HPP
#define MICROTIN_ENCODER_STREAM_HEADER_HPP

#include <cstdint>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/terrain/metadata.hpp"
#include "shared/format.hpp"

namespace microtin::stream {

// The notes that say something. Throws Error if they are too long.
std::vector<uint8_t> write_notes(const Metadata& metadata);

// What a note of bounds begins with, and all of a tile's chunk of them. Reading throws Error if it
// is malformed.
std::vector<uint8_t> write_span(const BoundSpan& span);
BoundSpan read_span(const uint8_t* begin, const uint8_t* end);

// Adds a note that fills up, if one is needed, until `before` bytes and all notes are a multiple of
// `alignment`. Throws Error if the notes are then too long.
void append_padding(std::vector<uint8_t>& notes, size_t before, size_t alignment);

// The placement must be known. Of several notes of a type the first counts; unknown types are
// skipped, and so is what follows the known content of a note. Throws Error if they are malformed.
void read_notes(const uint8_t* begin, const uint8_t* end, Metadata& metadata);

// Writing and reading a stream's header with all its notes.

// With the placement, the notes that say something, and the check. Throws Error if the
// notes are too long.
std::vector<uint8_t> write_header(const Contract& contract, const Metadata& metadata);

// Everything a header says.
struct Header {
  microtin_stream_info info;
  Contract contract;
  Metadata metadata;
};

// Throws Error if the header is cut off, damaged or not understood.
Header read_header(const std::vector<uint8_t>& stream);

// The stream with another header for the same terrain; notes of unknown types are dropped.
std::vector<uint8_t> with_metadata(const std::vector<uint8_t>& stream, const Metadata& metadata);

// Nothing where it is the lattice itself.
std::vector<uint8_t> write_placement(const Placement& placement);

// The `width` lowest bytes of a number, low ones first.
void append_number(std::vector<uint8_t>& bytes, uint64_t value, int width);

// A number in groups of seven bits, high ones first, the top bit set if more follow.
void append_varint(std::vector<uint8_t>& bytes, uint64_t value);

// 0, -1, 1, -2 ... become 0, 1, 2, 3 ...
uint64_t zigzag(int64_t value);

// Offset, numerator and denominator.
void append_axis(std::vector<uint8_t>& bytes, const Axis& axis);

// The check of `bytes` from `from` on, appended.
void append_check(std::vector<uint8_t>& bytes, size_t from);

}  // namespace microtin::stream

#endif
