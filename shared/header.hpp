// Reading the header: the fixed part and the placement.
#ifndef MICROTIN_SHARED_HEADER_HPP
#define MICROTIN_SHARED_HEADER_HPP

#include "microtin/microtin.h"
#include "shared/format.hpp"

namespace microtin {

// Whether the first bytes are those of a stream that this code can read.
inline microtin_status check_identity(const uint8_t* identity) {
  for (uint32_t i = 0; i < sizeof kMagic; ++i) {
    if (identity[i] != read_table(kMagic + i)) return MICROTIN_BAD_MAGIC;
  }
  return identity[4] == kVersion ? MICROTIN_DONE : MICROTIN_UNSUPPORTED_VERSION;
}

// Bytes of a fixed header with a known identity.
inline uint32_t fixed_header_bytes(const uint8_t* identity) {
  const uint8_t flags = identity[5];
  return kIdentityBytes + ((flags & kLongCount) != 0 ? 4u : 2u) +
         ((flags & kLongSides) != 0 ? 4u : 2u) + ((flags & kHasPlacement) != 0 ? 1u : 0u) +
         ((flags & kHasNotes) != 0 ? 2u : 0u);
}

// The fixed header and what follows it.
struct FixedHeader {
  Contract contract;
  uint32_t bytes;            // its own
  uint32_t placement_bytes;  // at most 255
  uint32_t note_bytes;       // at most 65535
};

// Bytes of the whole header before its check.
inline uint32_t checked_bytes(const FixedHeader& header) {
  return header.bytes + header.placement_bytes + header.note_bytes;
}

// A number of `width` bytes.
inline uint32_t take_number(const uint8_t** bytes, uint32_t width) {
  uint32_t value = 0;
  for (uint32_t i = 0; i < width; ++i) value |= static_cast<uint32_t>(*(*bytes)++) << 8 * i;
  return value;
}

// Reads a fixed header with a known identity. False if it breaks a rule of the format.
inline bool read_fixed_header(const uint8_t* bytes, FixedHeader* header) {
  const uint8_t flags = bytes[5], effort = bytes[6];
  const uint8_t* next = bytes + kIdentityBytes;
  const uint32_t side_width = (flags & kLongSides) != 0 ? 2 : 1;
  Contract& contract = header->contract;
  contract.has_heights = (flags & kHasHeights) != 0;
  contract.has_voids = (flags & kHasVoids) != 0;
  contract.degree = effort & 63u;
  contract.levels = static_cast<uint32_t>(effort) >> 6;
  contract.vertices = take_number(&next, (flags & kLongCount) != 0 ? 4 : 2);
  contract.x_max = static_cast<uint16_t>(take_number(&next, side_width));
  contract.y_max = static_cast<uint16_t>(take_number(&next, side_width));
  header->placement_bytes = take_number(&next, (flags & kHasPlacement) != 0 ? 1 : 0);
  header->note_bytes = take_number(&next, (flags & kHasNotes) != 0 ? 2 : 0);
  header->bytes = static_cast<uint32_t>(next - bytes);
  return flags <= kKnownFlags && contract.degree >= kMinDegree && contract.degree <= kMaxDegree &&
         contract.levels >= 1 && contract.vertices >= 3 && contract.vertices <= kMaxVertices;
}

// How many of a stream's first bytes are the header up to its notes, as far as `size` of them tell.
// A placement that is too long is not told.
inline uint32_t header_bytes(const uint8_t* bytes, size_t size) {
  if (size < kIdentityBytes || check_identity(bytes) != MICROTIN_DONE) return kIdentityBytes;
  if (size < fixed_header_bytes(bytes)) return fixed_header_bytes(bytes);
  FixedHeader header;
  read_fixed_header(bytes, &header);
  const bool placed = header.placement_bytes <= kPlacementMostBytes;
  return header.bytes + (placed ? header.placement_bytes : 0);
}

// A number in groups of seven bits, high ones first, the top bit set if more follow. False if it is
// longer than `bytes`, not in its shortest form, or above 64 bits.
inline bool read_varint(const uint8_t** bytes, const uint8_t* end, uint64_t* value) {
  *value = 0;
  while (*bytes != end) {
    const uint8_t byte = *(*bytes)++;
    if (*value >> 57 != 0 || (*value == 0 && byte == 128)) return false;
    *value = *value << 7 | (byte & 127u);
    if (byte < 128) return true;
  }
  return false;
}

// A numerator or denominator: 1 .. 2^40 - 1.
inline bool read_step(const uint8_t** bytes, const uint8_t* end, uint64_t* value) {
  return read_varint(bytes, end, value) && *value != 0 && *value >> 40 == 0;
}

// A placement: for x, y and z the offset (zigzag), numerator and denominator.
inline bool read_placement(const uint8_t* bytes, uint32_t size, microtin_axis* axis) {
  const uint8_t* const end = bytes + size;
  for (microtin_axis* const last = axis + 3; axis != last; ++axis) {
    uint64_t offset = 0;
    if (!read_varint(&bytes, end, &offset) || !read_step(&bytes, end, &axis->numerator) ||
        !read_step(&bytes, end, &axis->denominator)) {
      return false;
    }
    const int64_t half = static_cast<int64_t>(offset >> 1);
    axis->offset = (offset & 1u) != 0 ? -half - 1 : half;
  }
  return bytes == end;
}

}  // namespace microtin

#endif
