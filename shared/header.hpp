// Reading the header: the fixed part and the placement block.
#ifndef MICROTIN_SHARED_HEADER_HPP
#define MICROTIN_SHARED_HEADER_HPP

#include "microtin/microtin.h"
#include "shared/format.hpp"

namespace microtin {

// Whether the first bytes are those of a stream that this code can read.
inline microtin_status check_identity(const uint8_t* identity) {
  for (uint32_t i = 0; i < sizeof kMagic; ++i) {
    if (identity[i] != kMagic[i]) return MICROTIN_BAD_MAGIC;
  }
  return identity[4] == kVersion ? MICROTIN_DONE : MICROTIN_UNSUPPORTED_VERSION;
}

inline uint32_t dimensions_bytes(uint8_t flags) {
  return ((flags & kLongCount) != 0 ? 4u : 2u) + ((flags & kLongSides) != 0 ? 4u : 2u) +
         ((flags & kHasBlocks) != 0 ? 2u : 0u);
}

// Reads the dimensions, given the flags and the effort. False if the header breaks a rule of the
// format.
inline bool read_contract(uint8_t flags, uint8_t effort, const uint8_t* dimensions,
                          Contract* contract, uint32_t* block_bytes) {
  contract->has_heights = (flags & kHasHeights) != 0;
  contract->has_voids = (flags & kHasVoids) != 0;
  contract->degree = effort & 63u;
  contract->levels = effort >> 6;
  const bool long_count = (flags & kLongCount) != 0;
  contract->vertices = long_count ? read_u32(dimensions) : read_u16(dimensions);
  const uint8_t* const sides = dimensions + (long_count ? 4 : 2);
  if ((flags & kLongSides) != 0) {
    contract->x_max = static_cast<uint16_t>(read_u16(sides));
    contract->y_max = static_cast<uint16_t>(read_u16(sides + 2));
  } else {
    contract->x_max = sides[0];
    contract->y_max = sides[1];
  }
  const uint32_t bytes = dimensions_bytes(flags);
  *block_bytes = (flags & kHasBlocks) != 0 ? read_u16(dimensions + bytes - 2) : 0;
  return (flags >> 5) == 0 && contract->degree >= kMinDegree && contract->degree <= kMaxDegree &&
         contract->levels >= 1 && contract->vertices >= 3 && contract->vertices <= kMaxVertices;
}

// A number in groups of seven bits, low ones first, the top bit set if more follow. False if it is
// longer than `bytes`, not in its shortest form, or above 64 bits.
inline bool read_varint(const uint8_t** bytes, const uint8_t* end, uint64_t* value) {
  *value = 0;
  for (uint32_t shift = 0; *bytes != end; shift += 7) {  // ends at 63 at the latest
    const uint8_t byte = *(*bytes)++;
    if ((shift == 63 && byte > 1) || (shift != 0 && byte == 0)) return false;
    *value |= static_cast<uint64_t>(byte & 127u) << shift;
    if (byte < 128) return true;
  }
  return false;
}

constexpr uint64_t kStepLimit = static_cast<uint64_t>(1) << 40;

// The content of a placement block: for x, y and z the offset (zigzag), numerator and denominator.
inline bool read_placement(const uint8_t* bytes, uint32_t size, microtin_axis* axis) {
  const uint8_t* const end = bytes + size;
  for (int i = 0; i < 3; ++i) {
    uint64_t offset = 0, numerator = 0, denominator = 0;
    if (!read_varint(&bytes, end, &offset) || !read_varint(&bytes, end, &numerator) ||
        !read_varint(&bytes, end, &denominator)) {
      return false;
    }
    if (numerator == 0 || numerator >= kStepLimit || denominator == 0 ||
        denominator >= kStepLimit) {
      return false;
    }
    const uint64_t half = offset >> 1;  // < 2^63
    axis[i].offset =
        (offset & 1u) != 0 ? -static_cast<int64_t>(half) - 1 : static_cast<int64_t>(half);
    axis[i].numerator = numerator;
    axis[i].denominator = denominator;
  }
  return bytes == end;
}

}  // namespace microtin

#endif
