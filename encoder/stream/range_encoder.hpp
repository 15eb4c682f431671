// SPDX-License-Identifier: MIT
// The writing counterpart of decoder/range_decoder.hpp: bytes of one section's payload.
#ifndef MICROTIN_ENCODER_STREAM_RANGE_ENCODER_HPP
#define MICROTIN_ENCODER_STREAM_RANGE_ENCODER_HPP

#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/layers.hpp"
#include "shared/fixed_math.hpp"

namespace microtin::stream {

class RangeEncoder {
 public:
  // Writes `value`, a one having `probability` / 2^15, and returns it.
  bool bit(uint32_t probability, bool value) {
    // Without a branch: nobody can predict the value.
    const uint32_t bound = (range_ >> 15) * probability, if_zero = static_cast<uint32_t>(value) - 1;
    low_ += bound & if_zero;
    range_ = bound + ((range_ - 2 * bound) & if_zero);
    normalise();
    return value;
  }

  // Writes `value` < `count` <= 2^16, all equally likely, and returns it.
  uint32_t uniform(uint32_t count, uint32_t value);

  // Codes a value below `count`, or, if `value` >= `count`, an escape: `count` is returned.
  uint32_t uniform_or_escape(uint32_t count, uint32_t value);

  // Ends the payload and returns it. Trailing zero bytes that the decoder supplies itself are left
  // out.
  std::vector<uint8_t> finish();

 private:
  // A bit leaves a range of 2^15 or more, a number one of 2^8.
  void normalise() {
    const uint32_t shift = (31 - highest_bit(range_)) & 24u;
    range_ <<= shift;
    low_ <<= shift;
    ahead_ += shift;
    if (ahead_ >= 16) move_out();
  }

  void move_out();

  uint64_t low_ = 0;    // 32 bits, those ahead of them and a carry
  uint32_t ahead_ = 0;  // 0 or 8 before a bit, 0 before a number: at most 24 after either
  uint32_t range_ = 0xFFFFFFFFu;
  std::vector<uint8_t> bytes_;
  std::size_t size_ = 0;  // of them, this many are written
};

}  // namespace microtin::stream

#endif
