// SPDX-License-Identifier: MIT
// What the walk knows of vertices: whether each is queued, and whether its turn is over.
#ifndef MICROTIN_SHARED_MARKS_HPP
#define MICROTIN_SHARED_MARKS_HPP

#include "shared/mesh.hpp"

namespace microtin {

constexpr uint8_t kQueued = 1, kDone = 2;

// A vertex's marks are two bits of a byte, or where numbers are wide the whole byte.
constexpr uint32_t kMarkBits = MICROTIN_INDEX_BITS == 16 ? 2 : 8, kMarksInByte = 8 / kMarkBits;

constexpr uint32_t mark_bytes(uint32_t vertices) {
  return (vertices + kMarksInByte - 1u) / kMarksInByte;
}

inline uint32_t mark_shift(Index v) {
  return kMarkBits * (v % kMarksInByte);
}

// In the two lowest bits; those above are other vertices'.
inline uint32_t marks_of(const uint8_t* marks, Index v) {
  if (v == kInfinity) return kQueued | kDone;  // nobody asks before its turn is over
  return static_cast<uint32_t>(marks[v / kMarksInByte]) >> mark_shift(v);
}

inline bool is_done(const uint8_t* marks, Index v) {
  return (marks_of(marks, v) & kDone) != 0;
}

inline void mark(uint8_t* marks, Index v, uint8_t mark) {
  if (v == kInfinity) return;
  const uint32_t at = v / kMarksInByte;
  marks[at] = static_cast<uint8_t>(marks[at] | mark << mark_shift(v));
}

}  // namespace microtin

#endif
