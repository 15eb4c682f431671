// SPDX-License-Identifier: MIT
// The entropy coding of LAZ: an arithmetic decoder, and the models that adapt to what it decodes.
#ifndef MICROTIN_ENCODER_IMPORT_LAZ_CODER_HPP
#define MICROTIN_ENCODER_IMPORT_LAZ_CODER_HPP

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "encoder/layers.hpp"

namespace microtin::importing {

// Frequencies of the symbols 0 .. symbols - 1. The first use allocates the tables, because most
// models of a chunk are never used.
class LazModel {
 public:
  explicit LazModel(uint32_t symbols) : symbols_(symbols) {}  // 2 .. 1024

 private:
  friend class LazDecoder;

  void begin();
  void count(uint32_t symbol) {
    ++counts_[symbol];
    if (--until_update_ == 0) update();
  }
  uint32_t symbol_at(uint32_t share) const;
  void update();
  void fill_buckets();

  uint32_t symbols_;
  uint32_t total_ = 0;         // of the counts, at the last update
  uint32_t cycle_ = 0;         // symbols between updates; 0: there are no tables yet
  uint32_t until_update_ = 0;  // symbols
  uint32_t bucket_bits_ = 0;   // of a share, to divide it by the size of a bucket
  // At most 32,768 and what is counted until the next update, 8 * (1024 + 6): it fits.
  std::vector<uint16_t> counts_;
  // Where the shares of a symbol begin, of 2^15 in all; one entry more has the end.
  std::vector<uint16_t> starts_;
  // The symbol that has the first share of each bucket; one entry more has the last symbol. There
  // are about as many buckets as symbols.
  std::vector<uint16_t> buckets_;
};

// Frequencies of the bits 0 and 1.
class LazBitModel {
 private:
  friend class LazDecoder;

  void update();

  uint32_t zeros_ = 1, total_ = 2;
  uint32_t cycle_ = 4, until_update_ = 4;
  uint32_t zero_share_ = 1u << 12;  // of 2^13
};

// Decodes a piece of a file. Every function throws Error where the piece ends too early, or where
// it contains what no encoder writes. An Error does not name the file.
class LazDecoder {
 public:
  explicit LazDecoder(std::string_view bytes);  // which must outlive this

  uint32_t symbol(LazModel& model);
  uint32_t bit(LazBitModel& model);
  uint32_t raw(uint32_t bits);  // 1 .. 19 bits that are not modelled

 private:
  uint8_t next_byte();
  void renormalise();

  std::string_view bytes_;
  size_t used_ = 0;
  // value_ < length_, and length_ >= 2^24 between calls.
  uint32_t value_ = 0, length_ = 0xFFFFFFFF;
};

// Differences between integers and what is predicted for them.
class LazIntegers {
 public:
  LazIntegers(uint32_t bits, uint32_t contexts);  // 16 or 32 bits

  // The difference modulo 2^32, context < contexts.
  uint32_t difference(LazDecoder& decoder, uint32_t context);

  // About how many bits the last difference took: 0 .. bits.
  uint32_t width() const { return width_; }

 private:
  std::vector<LazModel> widths_;  // for each context
  LazBitModel narrowest_;         // what differs by 0 or 1
  std::vector<LazModel> high_;    // the high bits of what has a width, from 1 on
  uint32_t width_ = 0;
};

}  // namespace microtin::importing

#endif
