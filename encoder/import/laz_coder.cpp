// SPDX-License-Identifier: MIT
// The entropy coding of LAZ: an arithmetic decoder, and the models that adapt to what it decodes.
// A. Said, Introduction to Arithmetic Coding, HPL-2004-76, describes the method. The numbers of
// bits, the cycles and the roundings are those of LASzip, since a decoder must repeat them.
#include <algorithm>

#include "encoder/base/error.hpp"
#include "encoder/import/laz.hpp"

namespace microtin::importing {
namespace {

constexpr uint32_t kShareBits = 15, kBitShareBits = 13;
constexpr uint32_t kShares = 1u << kShareBits, kBitShares = 1u << kBitShareBits;
constexpr uint32_t kShortest = 1u << 24;  // of an interval, between symbols

// High bits of an integer that a model decodes; those below are not modelled.
constexpr uint32_t kModelledBits = 8;

[[noreturn]] void fail_on_symbol() {
  throw Error("contains what no compressor writes");
}

}  // namespace

void LazModel::begin() {
  while (1u << bucket_bits_ < symbols_) ++bucket_bits_;
  const uint32_t buckets = 1u << bucket_bits_;
  bucket_bits_ = kShareBits - bucket_bits_;
  counts_.assign(symbols_, 1);
  starts_.assign(symbols_ + 1, 0);
  buckets_.assign(buckets + 1, 0);
  cycle_ = symbols_;
  update();
  cycle_ = until_update_ = (symbols_ + 6) / 2;
}

// Every count is at least 1 and their sum at most 2^15, so that each symbol has a share: what
// follows `before` counts begins at floor(before * floor(2^31 / total) / 2^16).
void LazModel::update() {
  total_ += cycle_;
  if (total_ > kShares) {
    total_ = 0;
    for (uint16_t& count : counts_) {
      count = static_cast<uint16_t>((count + 1) / 2);
      total_ += count;
    }
  }
  const uint32_t scale = (1u << 31) / total_;
  uint32_t before = 0;
  for (uint32_t symbol = 0; symbol < symbols_; ++symbol) {
    starts_[symbol] = static_cast<uint16_t>((scale * before) >> (31 - kShareBits));
    before += counts_[symbol];
  }
  starts_[symbols_] = kShares;
  fill_buckets();
  cycle_ = std::min(5 * cycle_ / 4, 8 * (symbols_ + 6));
  until_update_ = cycle_;
}

void LazModel::fill_buckets() {
  size_t bucket = 0;
  const size_t buckets = buckets_.size() - 1;
  for (uint32_t symbol = 0; symbol < symbols_; ++symbol) {
    while (bucket < buckets && bucket << bucket_bits_ < starts_[symbol + 1]) {
      buckets_[bucket++] = static_cast<uint16_t>(symbol);
    }
  }
  buckets_[buckets] = static_cast<uint16_t>(symbols_ - 1);
}

uint32_t LazModel::symbol_at(uint32_t share) const {
  const size_t bucket = share >> bucket_bits_;
  uint32_t symbol = buckets_[bucket], end = buckets_[bucket + 1] + 1u;
  while (end - symbol > 1) {
    const uint32_t middle = (symbol + end) / 2;
    (starts_[middle] <= share ? symbol : end) = middle;
  }
  return symbol;
}

void LazBitModel::update() {
  total_ += cycle_;
  if (total_ > kBitShares) {
    total_ = (total_ + 1) / 2;
    zeros_ = (zeros_ + 1) / 2;
    if (zeros_ == total_) ++total_;
  }
  zero_share_ = zeros_ * ((1u << 31) / total_) >> (31 - kBitShareBits);
  cycle_ = std::min(5 * cycle_ / 4, 64u);
  until_update_ = cycle_;
}

LazDecoder::LazDecoder(std::string_view bytes) : bytes_(bytes) {
  for (int i = 0; i < 4; ++i) value_ = value_ << 8 | next_byte();
  if (value_ >= length_) fail_on_symbol();
}

// An encoder writes all bytes that a decoder reads, so none is read behind the end.
uint8_t LazDecoder::next_byte() {
  if (used_ == bytes_.size()) throw Error("ends before its last point");
  return static_cast<uint8_t>(bytes_[used_++]);
}

void LazDecoder::renormalise() {
  while (length_ < kShortest) {
    value_ = value_ << 8 | next_byte();
    length_ <<= 8;
  }
}

// A unit is at least 2^9, and each symbol has at least one of them: length_ does not become 0. What
// is left of the interval beyond 2^15 units belongs to the last symbol.
uint32_t LazDecoder::symbol(LazModel& model) {
  if (model.cycle_ == 0) model.begin();
  const uint32_t unit = length_ >> kShareBits;
  const uint32_t symbol = model.symbol_at(std::min(value_ / unit, kShares - 1));
  const uint32_t begin = model.starts_[symbol] * unit;
  const bool is_last = symbol + 1 == model.symbols_;
  length_ = (is_last ? length_ : model.starts_[symbol + 1] * unit) - begin;
  value_ -= begin;
  renormalise();
  model.count(symbol);
  return symbol;
}

uint32_t LazDecoder::bit(LazBitModel& model) {
  const uint32_t zero_length = model.zero_share_ * (length_ >> kBitShareBits);
  const uint32_t bit = value_ >= zero_length ? 1 : 0;
  if (bit == 0) {
    length_ = zero_length;
    ++model.zeros_;
  } else {
    length_ -= zero_length;
    value_ -= zero_length;
  }
  renormalise();
  if (--model.until_update_ == 0) model.update();
  return bit;
}

uint32_t LazDecoder::raw(uint32_t bits) {
  length_ >>= bits;
  const uint32_t value = value_ / length_;
  if (value >> bits != 0) fail_on_symbol();
  value_ -= value * length_;
  renormalise();
  return value;
}

LazIntegers::LazIntegers(uint32_t bits, uint32_t contexts) : widths_(contexts, LazModel(bits + 1)) {
  high_.reserve(bits);
  for (uint32_t width = 1; width <= bits; ++width) {
    high_.emplace_back(1u << std::min(width, kModelledBits));
  }
}

// A width of k stands for -(2^k - 1) .. -2^(k - 1) and 2^(k - 1) + 1 .. 2^k, in this order.
uint32_t LazIntegers::difference(LazDecoder& decoder, uint32_t context) {
  width_ = decoder.symbol(widths_[context]);
  if (width_ == 0) return decoder.bit(narrowest_);
  if (width_ == 32) return 1u << 31;
  uint32_t place = decoder.symbol(high_[width_ - 1]);
  if (width_ > kModelledBits) {
    uint32_t low_bits = width_ - kModelledBits, low = 0, done = 0;
    if (low_bits > 19) {  // the low half of them first
      low = decoder.raw(16);
      done = 16;
    }
    low |= decoder.raw(low_bits - done) << done;
    place = place << low_bits | low;
  }
  const uint32_t half = 1u << (width_ - 1);
  return place >= half ? place + 1 : place - (2 * half - 1);
}

}  // namespace microtin::importing
