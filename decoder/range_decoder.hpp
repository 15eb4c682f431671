// SPDX-License-Identifier: MIT
// The reading coder: a binary range decoder over the bytes of one section's payload.
#ifndef MICROTIN_DECODER_RANGE_DECODER_HPP
#define MICROTIN_DECODER_RANGE_DECODER_HPP

#include "shared/crc32.hpp"
#include "shared/format.hpp"
#include "shared/mesh.hpp"
#include "shared/probability.hpp"

namespace microtin {

// The next bytes of the stream. They are copied here, so that what an item needs is in one piece
// however the stream arrives.
struct ByteWindow {
  uint8_t* next;
  size_t left;    // from `next` on
  uint32_t crc;   // of all that was taken since the last check, up to the last settle()
  uint64_t used;  // bytes of the stream up to the last settle()
  uint8_t bytes[2 * kStepBytes];

  uint8_t take() {
    --left;
    return *next++;
  }

  void skip(uint32_t count) {
    next += count;
    left -= static_cast<size_t>(count);
  }

  // Bytes of the stream so far.
  uint64_t taken() const { return used + static_cast<size_t>(next - bytes); }

  // Counts and checks what was taken, and moves what is left to the front.
  MICROTIN_OUT_OF_LINE void settle() {
    crc = crc32(crc, bytes, static_cast<size_t>(next - bytes));
    used = taken();
    for (size_t i = 0; i < left; ++i) bytes[i] = next[i];
    next = bytes;
  }

  // Adds from `size` bytes what there is room for, and returns their number.
  size_t fill(const uint8_t* from, size_t size) {
    settle();
    size_t added = 0;
#if defined(MICROTIN_LARGE_TABLES)
    for (; size - added >= 8 && sizeof bytes - left >= 8; added += 8, left += 8) {
      __builtin_memcpy(bytes + left, from + added, 8);
    }
#endif
    while (added < size && left < sizeof bytes) bytes[left++] = from[added++];
    return added;
  }
};

constexpr uint32_t kRangeLeast = static_cast<uint32_t>(1) << 24;

static_assert((kRangeLeast >> 15) * kProbabilityMargin >= kProbabilityOne,
              "no part of a bit is narrow");
static_assert(kRangeLeast >> 16 >= 1 << 8, "after any number two bytes are enough");

// Interval coding after Schindler and LZMA: `code` is the stream's value relative to the interval's
// low end, always below `range`; `range` stays at or above 2^24 between calls.
// The two are not side by side: else GCC makes a vector of them, and takes it apart for each bit.
struct RangeDecoder {
  uint32_t range;
  uint32_t payload_left;  // bytes not read yet before the check: of notes, or a section's payload
  uint32_t virtual_left;  // zero bytes that may still be read behind it
  uint32_t code;
  bool overrun;       // more was asked for than there is, or no encoder can have written this
  ByteWindow window;  // holds at least min(payload_left, kStepBytes) bytes when a step starts

  uint32_t next_byte() {
    if (payload_left != 0) {
      --payload_left;
      return window.take();
    }
    if (virtual_left == 0) {
      overrun = true;
    } else {
      --virtual_left;
    }
    return 0;
  }

  // At a section's payload, of which payload_left tells the bytes.
  void begin() {
    virtual_left = kVirtualBytes;
    overrun = false;
    range = 0xFFFFFFFFu;
    code = 0;
    for (int i = 0; i < 4; ++i) code = code << 8 | next_byte();
    if (code == range) overrun = true;  // no encoder's interval ends there
  }

  MICROTIN_IN_PLACE void normalise() {
    if (range < kRangeLeast) refill();
  }

  MICROTIN_OUT_OF_LINE void refill() {
    do {  // at most twice, as range >= 2^8 here; three times where a number is none
      range <<= 8;
      code = code << 8 | next_byte();
    } while (range < kRangeLeast);
  }

  // A bit that is one with `probability` / 2^15. Both parts of the interval are at least
  // 2^9 * kProbabilityMargin wide.
  bool bit(uint32_t probability, bool) {
    const uint32_t bound = (range >> 15) * probability;
    const bool one = code < bound;
    if (one) {
      range = bound;
    } else {
      code -= bound;
      range -= bound;
    }
    normalise();
    return one;
  }

  // A number below `count`, all equally likely; 1 <= count <= 2^16.
  uint32_t uniform(uint32_t count, uint32_t) {
    const uint32_t value = take(range, count);
    if (value < count) return value;
    overrun = true;  // in the part of the interval lost to rounding: no encoder goes there
    range = 0xFFFFFFFFu;
    code = 0;
    return 0;
  }

  // A number below `count`, or `count` for an escape; count <= 2^14.
  uint32_t uniform_or_escape(uint32_t count, uint32_t) {
    return take(range - (range >> kEscapeBits), count);
  }

  // One of `count` equal parts of `width`, or `count` for what they leave of the interval. A part
  // is at least 2^8 wide.
  MICROTIN_ONE_COPY uint32_t take(uint32_t width, uint32_t count) {
    const uint32_t part = width / count;
    uint32_t value = code / part;
    if (value < count) {
      range = part;
    } else {
      value = count;
      range -= count * part;
    }
    code -= value * part;
    normalise();
    return value;
  }

  Vertex next() const { return Vertex{0, 0, 0}; }
  bool last_phase() const { return false; }
  uint32_t batch() const { return 0; }
  bool conflicts(const Mesh&, Index) const { return false; }
  bool is_void(const Mesh&, Index) const { return false; }
};

}  // namespace microtin

#endif
