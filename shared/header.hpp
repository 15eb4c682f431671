// SPDX-License-Identifier: MIT
// Reading the header, and the numbers of variable length in it.
#ifndef MICROTIN_SHARED_HEADER_HPP
#define MICROTIN_SHARED_HEADER_HPP

#include "microtin/microtin.h"
#include "shared/format.hpp"
#include "shared/lattice.hpp"

namespace microtin {

// Whether the first bytes are those of a stream that this code can read.
MICROTIN_ONE_COPY MICROTIN_OUT_OF_LINE inline microtin_status check_identity(
    const uint8_t* identity) {
  constexpr uint32_t kNumber = number_of(kMagic);
  if (read_u32(identity) != kNumber) return MICROTIN_STATUS_BAD_MAGIC;
  return identity[4] == kVersion ? MICROTIN_STATUS_OK : MICROTIN_STATUS_UNSUPPORTED_VERSION;
}

// Takes a byte into a length, 0 before the first: seven bits a byte, high ones first, the top bit
// set if more follow. True if more do. A length of more than 31 bits, or not in its shortest form,
// ends where that shows, counts as 0 and is not legal.
inline bool take_length(uint32_t* length, uint8_t byte, bool* legal) {
  *legal = *length >> 24 == 0 && (*length != 0 || byte != 128);
  *length = *legal ? *length << 7 | (byte & 127u) : 0;
  return *legal && byte >= 128;
}

// A number in groups of seven bits, as lengths are. False if it is longer than `bytes`, not in its
// shortest form, or above 64 bits.
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

// Number by number: on AVR a constant to copy from would be in RAM.
inline void place_on_lattice(microtin_axis* axis) {
  for (int i = 0; i < 3; ++i) {
    axis[i].offset = 0;
    axis[i].numerator = 1;
    axis[i].denominator = 1;
  }
}

// In an info all at once, since there they lie in a row.
template <class Info>
MICROTIN_IN_PLACE inline void put_axes(const microtin_axis* axis, Info* info) {
  static_assert(offsetof(Info, z) == offsetof(Info, x) + 2 * sizeof *axis, "nothing between them");
  __builtin_memcpy(reinterpret_cast<uint8_t*>(info) + offsetof(Info, x), axis, 3 * sizeof *axis);
}

// The offset (zigzag), numerator and denominator.
inline bool read_axis(const uint8_t** bytes, const uint8_t* end, microtin_axis* axis) {
  uint64_t offset = 0;
  if (!read_varint(bytes, end, &offset) || !read_step(bytes, end, &axis->numerator) ||
      !read_step(bytes, end, &axis->denominator)) {
    return false;
  }
  const int64_t half = static_cast<int64_t>(offset >> 1);
  axis->offset = (offset & 1u) != 0 ? -half - 1 : half;
  return true;
}

// A placement: the axes of x, y and z. What is not legal leaves `axis` on the lattice itself.
MICROTIN_ONE_COPY inline bool read_placement(const uint8_t** bytes, const uint8_t* end,
                                             microtin_axis* axis) {
  for (int i = 0; i < 3; ++i) {
    if (read_axis(bytes, end, axis + i)) continue;
    place_on_lattice(axis);
    return false;
  }
  return true;
}

// How far the surface is from its source at most: the number stored less one, in sixteenths of a z
// step. 0 stands for a margin that is not stated.
inline bool read_margin(const uint8_t** bytes, const uint8_t* end, uint32_t* margin) {
  uint64_t number = 0;
  if (!read_varint(bytes, end, &number) || number > kMarginMost + 1) return false;
  *margin = static_cast<uint32_t>(number) - 1;
  return true;
}

inline bool read_margins(const uint8_t** bytes, const uint8_t* end, Contract* contract) {
  return read_margin(bytes, end, &contract->below) && read_margin(bytes, end, &contract->above);
}

// Whether this build decodes streams with such properties. Coding 0 is a later version's.
inline bool is_supported(uint32_t properties) {
  constexpr uint32_t kCodings =
      (kBuiltQuick ? 1u << static_cast<uint32_t>(Coding::kQuick) : 0u) |
      (kBuiltBalanced ? 1u << static_cast<uint32_t>(Coding::kBalanced) : 0u) |
      (kBuiltDense ? 1u << static_cast<uint32_t>(Coding::kDense) : 0u);
  return (kCodings >> (properties >> 3 & 3u) & 1u) != 0 &&
         (kBuiltVoids || (properties & kHasVoids) == 0);
}

// Reads a header's payload up to its notes. Without a placement `axis` is on the lattice itself.
// Not OK: MALFORMED, or UNSUPPORTED_VERSION if it has properties unknown here, since these may
// change what follows, or properties that this build leaves out.
inline microtin_status read_header(const uint8_t** bytes, const uint8_t* end, Contract* contract,
                                   microtin_axis* axis) {
  uint64_t number[4];  // properties, vertices, x_max, y_max
  place_on_lattice(axis);
  for (int i = 0; i < 4; ++i) {
    if (!read_varint(bytes, end, number + i)) return MICROTIN_STATUS_MALFORMED;
    if (number[0] >> kPropertyBits != 0) return MICROTIN_STATUS_UNSUPPORTED_VERSION;
  }
  const uint32_t properties = static_cast<uint32_t>(number[0]);
  if (!is_supported(properties)) return MICROTIN_STATUS_UNSUPPORTED_VERSION;
  contract->has_heights = (properties & kHasHeights) != 0;
  contract->has_voids = kBuiltVoids && (properties & kHasVoids) != 0;
  contract->coding = static_cast<Coding>(properties >> 3 & 3u);
  contract->degree = properties >> 5 & 63u;
  contract->odd_origin_x = (properties & kOddOriginX) != 0;
  contract->odd_origin_y = (properties & kOddOriginY) != 0;
  contract->vertices = static_cast<uint32_t>(number[1]);
  contract->x_max = static_cast<uint16_t>(number[2]);
  contract->y_max = static_cast<uint16_t>(number[3]);
  contract->below = contract->above = kNotStated;
  bool legal = (properties & kHasMargins) == 0 || read_margins(bytes, end, contract);
  legal = legal && ((properties & kHasPlacement) == 0 || read_placement(bytes, end, axis));
  legal = legal && contract->degree >= kMinDegree && contract->degree <= kMaxDegree &&
          number[1] >= 3 && number[1] <= kMaxVertices && number[2] <= kLatticeMax &&
          number[3] <= kLatticeMax;
  return legal ? MICROTIN_STATUS_OK : MICROTIN_STATUS_MALFORMED;
}

}  // namespace microtin

#endif
