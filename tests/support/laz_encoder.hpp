// SPDX-License-Identifier: MIT
// The entropy coding of LAZ, for tests: an encoder of its own, as plain as it can be.
#ifndef MICROTIN_TESTS_SUPPORT_LAZ_ENCODER_HPP
#define MICROTIN_TESTS_SUPPORT_LAZ_ENCODER_HPP

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/layers.hpp"

namespace microtin::tests {

// The shares of symbols, of 2^15 in all. They follow the counts now and then.
class SymbolShares {
 public:
  explicit SymbolShares(uint32_t symbols) : symbols_(symbols) {}

  // Before each use; the first allocates memory, since most are never used.
  void begin_use() {
    if (cycle_ != 0) return;
    counts_.assign(symbols_, 1);
    begins_.resize(symbols_ + 1);
    share_out();
    cycle_ = left_ = (symbols_ + 6) / 2;
  }

  uint32_t begin(uint32_t symbol) const { return begins_[symbol]; }
  bool is_last(uint32_t symbol) const { return symbol + 1 == counts_.size(); }

  void count(uint32_t symbol) {
    ++counts_[symbol];
    if (--left_ != 0) return;
    if (sum() > 32768) {
      for (uint32_t& count : counts_) count = (count + 1) / 2;
    }
    share_out();
    const auto longest = 8 * static_cast<uint32_t>(counts_.size() + 6);
    cycle_ = left_ = std::min(5 * cycle_ / 4, longest);
  }

 private:
  uint32_t sum() const {
    uint32_t sum = 0;
    for (const uint32_t count : counts_) sum += count;
    return sum;
  }

  void share_out() {
    const uint32_t scale = 0x80000000u / sum();
    uint32_t before = 0;
    for (size_t i = 0; i < counts_.size(); ++i) {
      begins_[i] = scale * before >> 16;
      before += counts_[i];
    }
    begins_.back() = 32768;
  }

  uint32_t symbols_;
  std::vector<uint32_t> counts_, begins_;
  uint32_t cycle_ = 0, left_ = 0;
};

// The share of zeros, of 2^13.
class BitShares {
 public:
  uint32_t zeros() const { return zeros_ * (0x80000000u / all_) >> 18; }

  void count(bool bit) {
    if (!bit) ++next_zeros_;
    if (--left_ != 0) return;
    all_ += cycle_;
    zeros_ = next_zeros_;
    if (all_ > 8192) {
      all_ = (all_ + 1) / 2;
      zeros_ = (zeros_ + 1) / 2;
      if (zeros_ == all_) ++all_;
    }
    next_zeros_ = zeros_;
    cycle_ = left_ = std::min(5 * cycle_ / 4, 64u);
  }

 private:
  uint32_t zeros_ = 1, next_zeros_ = 1, all_ = 2;  // zeros_ and all_ are those of the last update
  uint32_t cycle_ = 4, left_ = 4;
};

class LazEncoder {
 public:
  void symbol(SymbolShares& shares, uint32_t symbol) {
    shares.begin_use();
    const uint32_t unit = length_ >> 15, begin = shares.begin(symbol) * unit;
    const uint32_t end = shares.is_last(symbol) ? length_ : shares.begin(symbol + 1) * unit;
    narrow(begin, end - begin);
    shares.count(symbol);
    is_used_ = true;
  }

  void bit(BitShares& shares, bool bit) {
    const uint32_t zeros = shares.zeros() * (length_ >> 13);
    narrow(bit ? zeros : 0, bit ? length_ - zeros : zeros);
    shares.count(bit);
  }

  void raw(uint32_t value, uint32_t bits) {
    const uint32_t unit = length_ >> bits;
    narrow(value * unit, unit);
  }

  bool is_used() const { return is_used_; }

  // A decoder reads four bytes ahead.
  std::string finished() const {
    std::string bytes = bytes_;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(base_ >> shift);
    return bytes;
  }

 private:
  void narrow(uint32_t offset, uint32_t length) {
    base_ += offset;
    if (base_ < offset) carry();
    length_ = length;
    while (length_ < 1u << 24) {
      bytes_ += static_cast<char>(base_ >> 24);
      base_ <<= 8;
      length_ <<= 8;
    }
  }

  void carry() {
    size_t i = bytes_.size();
    do {
      --i;
      bytes_[i] = static_cast<char>(static_cast<uint8_t>(bytes_[i]) + 1);
    } while (bytes_[i] == 0);
  }

  std::string bytes_;
  uint32_t base_ = 0, length_ = 0xFFFFFFFF;
  bool is_used_ = false;
};

// Integers of 16 or 32 bits, as differences from what is predicted.
class IntegerEncoder {
 public:
  IntegerEncoder(uint32_t bits, uint32_t contexts)
      : bits_(bits), widths_(contexts, SymbolShares(bits + 1)) {
    for (uint32_t k = 1; k <= bits; ++k) places_.emplace_back(1u << std::min(k, 8u));
  }

  void encode(LazEncoder& encoder, int32_t predicted, int32_t value, uint32_t context) {
    int64_t difference =
        static_cast<int32_t>(static_cast<uint32_t>(value) - static_cast<uint32_t>(predicted));
    if (bits_ == 16) difference = static_cast<int16_t>(difference);
    width_ = 0;  // the least with 1 - 2^width <= difference <= 2^width
    while (difference < 1 - (int64_t{1} << width_) || difference > int64_t{1} << width_) ++width_;
    encoder.symbol(widths_[context], width_);
    if (width_ == 0) return encoder.bit(smallest_, difference == 1);
    if (width_ == 32) return;
    const int64_t place = difference > 0 ? difference - 1 : difference + (int64_t{1} << width_) - 1;
    const uint32_t low_bits = width_ > 8 ? width_ - 8 : 0;
    encoder.symbol(places_[width_ - 1], static_cast<uint32_t>(place >> low_bits));
    const auto low = static_cast<uint32_t>(place & ((int64_t{1} << low_bits) - 1));
    if (low_bits > 19) {
      encoder.raw(low & 0xFFFF, 16);
      encoder.raw(low >> 16, low_bits - 16);
    } else if (low_bits != 0) {
      encoder.raw(low, low_bits);
    }
  }

  uint32_t width() const { return width_; }

 private:
  uint32_t bits_;
  std::vector<SymbolShares> widths_, places_;
  BitShares smallest_;
  uint32_t width_ = 0;
};

}  // namespace microtin::tests

#endif
