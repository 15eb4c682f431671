// SPDX-License-Identifier: MIT
// Carries are put off until bytes are sure.
#include "encoder/stream/range_encoder.hpp"

#include <utility>

#include "shared/format.hpp"
#include "shared/probability.hpp"

namespace microtin::stream {

uint32_t RangeEncoder::uniform(uint32_t count, uint32_t value) {
  if (count == 1) return 0;
  range_ /= count;
  low_ += static_cast<uint64_t>(value) * range_;
  normalise();
  return value;
}

uint32_t RangeEncoder::uniform_or_escape(uint32_t count, uint32_t value) {
  const uint32_t part = (range_ - (range_ >> kEscapeBits)) / count;
  if (value >= count) value = count;
  low_ += static_cast<uint64_t>(value) * part;
  range_ = value == count ? range_ - value * part : part;
  normalise();
  return value;
}

void RangeEncoder::shift_low() {
  const bool carry = low_ >> 32 != 0;
  if (carry || low_ < 0xFF000000u) {
    if (started_) bytes_.push_back(static_cast<uint8_t>(held_ + carry));
    for (; held_ones_ != 0; --held_ones_) {
      bytes_.push_back(static_cast<uint8_t>(0xFF + carry));
    }
    held_ = static_cast<uint8_t>(low_ >> 24);
    started_ = true;
  } else {
    ++held_ones_;
  }
  low_ = (low_ & 0x00FFFFFFu) << 8;
}

std::vector<uint8_t> RangeEncoder::finish() {
  // Any number in [low, low + range) will do: take the one with the most trailing zero bytes.
  for (int zero_bits = 32; zero_bits >= 0; zero_bits -= 8) {
    const uint64_t mask = (uint64_t{1} << zero_bits) - 1;
    const uint64_t value = (low_ + mask) & ~mask;
    if (value < low_ + range_) {
      low_ = value;
      break;
    }
  }
  for (int i = 0; i < 5; ++i) shift_low();
  for (uint32_t i = 0; i < kVirtualBytes && !bytes_.empty() && bytes_.back() == 0; ++i) {
    bytes_.pop_back();
  }
  return std::move(bytes_);
}

}  // namespace microtin::stream
