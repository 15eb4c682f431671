// SPDX-License-Identifier: MIT
// Bytes are written before all carries are known: one that comes later raises them.
#include "encoder/stream/range_encoder.hpp"

#include <utility>

#include "shared/format.hpp"
#include "shared/probability.hpp"

namespace microtin::stream {

uint32_t RangeEncoder::uniform(uint32_t count, uint32_t value) {
  if (count == 1) return 0;
  move_out();
  range_ /= count;
  low_ += static_cast<uint64_t>(value) * range_;
  normalise();
  return value;
}

uint32_t RangeEncoder::uniform_or_escape(uint32_t count, uint32_t value) {
  move_out();
  const uint32_t part = (range_ - (range_ >> kEscapeBits)) / count;
  if (value >= count) value = count;
  low_ += static_cast<uint64_t>(value) * part;
  range_ = value == count ? range_ - value * part : part;
  normalise();
  return value;
}

// Moves the bytes ahead to those written.
void RangeEncoder::move_out() {
  const uint64_t digits = low_ >> 32;
  if (digits >> ahead_ != 0) {
    for (std::size_t i = size_; ++bytes_[--i] == 0;) {
    }
  }
  if (bytes_.size() < size_ + 4) bytes_.resize(2 * size_ + 64);
  const uint32_t left = static_cast<uint32_t>(digits << (32 - ahead_));
  for (uint32_t i = 0; i < 4; ++i) bytes_[size_ + i] = static_cast<uint8_t>(left >> (24 - 8 * i));
  size_ += ahead_ / 8;
  low_ &= 0xFFFFFFFFu;
  ahead_ = 0;
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
  move_out();
  low_ <<= 32;
  ahead_ = 32;
  move_out();
  for (uint32_t i = 0; i < kVirtualBytes && size_ != 0 && bytes_[size_ - 1] == 0; ++i) --size_;
  bytes_.resize(size_);
  return std::move(bytes_);
}

}  // namespace microtin::stream
