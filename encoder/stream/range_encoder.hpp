// SPDX-License-Identifier: MIT
// The writing counterpart of decoder/range_decoder.hpp: bytes of one section's payload.
#ifndef MICROTIN_ENCODER_STREAM_RANGE_ENCODER_HPP
#define MICROTIN_ENCODER_STREAM_RANGE_ENCODER_HPP

#include <cstdint>
#include <vector>

#include "encoder/layers.hpp"

namespace microtin::stream {

class RangeEncoder {
 public:
  // Writes `value`, a one having `probability` / 2^15, and returns it.
  bool bit(uint32_t probability, bool value) {
    const uint32_t bound = (range_ >> 15) * probability;
    if (value) {
      range_ = bound;
    } else {
      low_ += bound;
      range_ -= bound;
    }
    normalise();
    return value;
  }

  // Writes `value` < `count` <= 2^16, all equally likely, and returns it.
  uint32_t uniform(uint32_t count, uint32_t value);

  // The same, or, if `value` >= `count`, an escape: `count` is returned.
  uint32_t uniform_or_escape(uint32_t count, uint32_t value);

  // Ends the payload and returns it. Trailing zero bytes that the decoder supplies itself are left
  // out.
  std::vector<uint8_t> finish();

 private:
  void normalise() {
    while (range_ < (1u << 24)) {
      range_ <<= 8;
      shift_low();
    }
  }

  void shift_low();

  uint64_t low_ = 0;  // 32 bits and a carry
  uint32_t range_ = 0xFFFFFFFFu;
  uint8_t held_ = 0;        // the last byte, which a carry may still raise ...
  uint64_t held_ones_ = 0;  // ... and the 0xFF bytes behind it
  bool started_ = false;    // the first byte held is always 0 and not written
  std::vector<uint8_t> bytes_;
};

}  // namespace microtin::stream

#endif
