// SPDX-License-Identifier: MIT
// LAZ: the points of a LAS file, compressed in chunks, and the entropy coding of the chunks. The
// coder has a source of its own.
#ifndef MICROTIN_ENCODER_IMPORT_LAZ_HPP
#define MICROTIN_ENCODER_IMPORT_LAZ_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "encoder/files/input.hpp"
#include "encoder/layers.hpp"

namespace microtin::importing {

// What is read of a point of a laser scan, and where a record of LAS has it.
struct ScanPoint {
  std::array<int32_t, 3> place;  // x, y and z in steps of the header's scales
  uint8_t class_code;
  bool is_withheld;
};

// The record that begins at a byte. Point formats 6 to 10 have other flags than 0 to 5 have.
inline ScanPoint scan_point_at(const ByteReader& bytes, uint64_t at, uint8_t point_format) {
  ScanPoint point{};
  for (size_t axis = 0; axis < 3; ++axis) {
    point.place[axis] = bytes.number<int32_t>(at + 4 * axis);
  }
  const auto flags = bytes.number<uint8_t>(at + 15);
  const bool is_recent = point_format >= 6;
  point.class_code = is_recent ? bytes.number<uint8_t>(at + 16) : static_cast<uint8_t>(flags & 31);
  point.is_withheld = (flags & (is_recent ? 4 : 128)) != 0;
  return point;
}

// What a record of LAS consists of.
struct LazRecord {
  uint8_t point_format = 0;  // 0 .. 3 point by point; 6 .. 10 in layers
  uint32_t bytes = 0;
  bool has_time = false, has_colour = false;  // in formats 0 to 3
  uint32_t extra_bytes = 0;                   // in formats 0 to 3
  uint32_t layers = 0;                        // in formats 6 to 10
};

// The points of a chunk; `count` is 1 or more. Memory grows with what is decoded. Throws Error,
// which does not name the file or the chunk, if the bytes are damaged.
std::vector<ScanPoint> unpack_chunk(std::string_view bytes, uint32_t count,
                                    const LazRecord& record);

// What the header and a record of a file state about its compressed points.
struct LazHeader {
  uint8_t point_format;  // without the mark of compression
  uint16_t point_bytes;
  uint64_t first_point;  // the byte where the header says that points begin
  uint64_t points;
  std::string_view record;  // of LASzip; empty: there is none
};

// All points in their order, a list for each chunk. Chunks are decoded on all processors. Throws
// Error that names the file and the chunk.
std::vector<std::vector<ScanPoint>> unpack_laz(const std::string& name, const ByteReader& file,
                                               const LazHeader& header);

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
