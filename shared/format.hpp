// SPDX-License-Identifier: MIT
// The constants of the format, the fixed part of its header, and which parts this build decodes.
// format-stream.md explains them.
#ifndef MICROTIN_SHARED_FORMAT_HPP
#define MICROTIN_SHARED_FORMAT_HPP

#include <stddef.h>
#include <stdint.h>

#include "microtin/config.h"
#include "shared/tables.hpp"

namespace microtin {

constexpr uint8_t kMagic[4] = {'m', 't', 'i', 'n'};
constexpr uint8_t kVersion = 6;
constexpr uint32_t kMinDegree = 6, kMaxDegree = 32;
constexpr uint32_t kMaxVertices = 16777216;  // 2^24

// A section of the body ends with the first phase that brings the terrain to this many vertices,
// and with every phase after it.
constexpr uint32_t kSectionVertices = 256;

// Payload bytes that suffice for any step. Most are used by a vertex on a hull edge: a decision,
// its gap (19 decisions and 15 uniform bits) and its height (19 decisions and 15 uniform bits), at
// 9 bits a decision, are 48 bytes (proofs.md, "Payload bytes of a work unit"). A number that
// is none may take 32 bits instead of 15: gaps and heights of which the decisions learn on the way
// leave room.
constexpr uint32_t kStepBytes = 48;

// Bytes of zero that stand virtually behind a section's payload.
constexpr uint32_t kVirtualBytes = 4;

// Vertices of all phases together that a stream may walk around. Every phase of the encoder leaves
// about 2/3 of its vertices at most: 3 n and 7 per phase suffice (proofs.md, "Work").
constexpr uint32_t work_budget(uint32_t vertices) {
  return 3 * vertices + 512;
}

// The sum that breaks the budget is beyond it by one phase at most.
static_assert(work_budget(kMaxVertices) + uint64_t{kMaxVertices} <= UINT32_MAX, "work fits");

// How much of the odds of places a stream makes use of (place_coding.hpp): the more, the smaller
// and the slower to decode.
enum class Coding : uint8_t { kQuick = 1, kBalanced = 2, kDense = 3 };

// A margin that a stream does not state. Others are at most kMarginMost: all heights there are.
constexpr uint32_t kNotStated = 0xFFFFFFFF;
constexpr uint32_t kMarginMost = 1048576;  // 2^20 sixteenths

// What the fixed header promises.
struct Contract {
  uint32_t vertices;
  uint16_t x_max, y_max;
  uint32_t degree;  // most triangles around a vertex when it is inserted
  Coding coding;
  bool has_heights;
  bool has_voids;
  bool odd_origin_x = false, odd_origin_y = false;  // of the stream's lattice on its pack's
  uint32_t below = kNotStated, above = kNotStated;  // margins, in sixteenths of a z step
};

// Lattice places that vertices can lie on, modulo 2^32: 2^32 are 0.
inline uint32_t lattice_places(const Contract& contract) {
  return (static_cast<uint32_t>(contract.x_max) + 1u) *
         (static_cast<uint32_t>(contract.y_max) + 1u);
}

// A stream begins with magic 4 and version 1. What follows of the header is framed as sections are:
// its length, then properties, vertices, x_max, y_max, margins, the placement, notes; the CRC-32 of
// all before.
constexpr uint32_t kIdentityBytes = 5;
constexpr uint32_t kCheckBytes = 4;
constexpr uint32_t kPlacementMostBytes = 66;  // 3 * (10 + 6 + 6)
constexpr uint32_t kHeaderMostBytes =
    2 + 4 + 3 + 3 + 3 + 3 + kPlacementMostBytes;  // before the notes

// Properties: these flags, 8 * decoding, 32 * degree. All further bits are for later versions.
constexpr uint32_t kHasHeights = 1, kHasVoids = 2, kHasPlacement = 4;
constexpr uint32_t kOddOriginX = 2048, kOddOriginY = 4096;
constexpr uint32_t kHasMargins = 8192;
constexpr uint32_t kPropertyBits = 14;

// Behind the last section come chunks, which decoding does not need: a type and a length below this
// (varints), the content, the CRC-32 of all three.
constexpr uint32_t kChunkNumberEnd = 0x80000000;

// Notes are for people and applications; decoding needs none of them. A type byte (microtin.h has
// the types), a length (2 bytes), the content.
constexpr uint32_t kNoteHeadBytes = 3;
constexpr uint32_t kNotesMostBytes = 65535;

// A magic as read_u32 reads it from a file.
constexpr uint32_t number_of(const uint8_t (&magic)[4]) {
  return magic[0] | static_cast<uint32_t>(magic[1]) << 8 | static_cast<uint32_t>(magic[2]) << 16 |
         static_cast<uint32_t>(magic[3]) << 24;
}

inline uint32_t read_u16(const uint8_t* p) {
  return p[0] | static_cast<uint32_t>(p[1]) << 8;
}

inline uint32_t read_u32(const uint8_t* p) {
  return read_u16(p) | read_u16(p + 2) << 16;
}

// What this build decodes: the switches of config.h as constants. Code tests them with `if`.
#if defined(MICROTIN_NO_VOIDS)
constexpr bool kBuiltVoids = false;
#else
constexpr bool kBuiltVoids = true;
#endif

#if defined(MICROTIN_ONLY_QUICK)
constexpr bool kBuiltQuick = true, kBuiltBalanced = false, kBuiltDense = false;
#elif defined(MICROTIN_ONLY_BALANCED)
constexpr bool kBuiltQuick = false, kBuiltBalanced = true, kBuiltDense = false;
#else
constexpr bool kBuiltQuick = true, kBuiltBalanced = true, kBuiltDense = true;
#endif

constexpr bool kBuiltWeighed = kBuiltBalanced || kBuiltDense;  // codings that weigh places

}  // namespace microtin

#endif
