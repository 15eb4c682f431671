// SPDX-License-Identifier: MIT
// Heights at single places of a stream or a pack: of the exact plane, or as a device answers.
#ifndef MICROTIN_ENCODER_PRODUCT_PLACE_QUERY_HPP
#define MICROTIN_ENCODER_PRODUCT_PLACE_QUERY_HPP

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/export/queries.hpp"
#include "encoder/files/input.hpp"
#include "encoder/layers.hpp"
#include "encoder/pack/file.hpp"
#include "encoder/product/document.hpp"
#include "encoder/terrain/metadata.hpp"
#include "microtin/pack.h"

namespace microtin::product {

// What begins as a stream or a pack, but is not whole.
struct Damaged : Error {
  using Error::Error;
};

// A pack as a device reads it, tile by tile as they are needed. Its memory is that of usual tiles,
// and grows when a larger one is needed whose stream says so.
class AskedPack {
 public:
  // Throws Damaged, or Error if the header is of another version.
  explicit AskedPack(std::unique_ptr<ByteSource> bytes);

  const microtin_pack_info& info() const { return info_; }

  // Returns what microtin_pack_height_at returns; `file` is the same pack. Throws Error if the file
  // cannot be read.
  microtin_query_result height_at(int64_t x, int64_t y, const PackFile& file, int32_t* height);

 private:
  microtin_status serve(int64_t x, int64_t y);
  void lay_out(uint32_t slots, uint32_t capacity);
  uint32_t wanted_capacity(const PackFile& file) const;

  std::unique_ptr<ByteSource> bytes_;
  std::vector<uint64_t> space_;
  microtin_pack* pack_ = nullptr;
  microtin_pack_info info_{};
  uint32_t capacity_ = 0;  // vertices that a slot has room for
  uint32_t hint_ = 0;
};

class PlaceQuery {
 public:
  // "-" is a stream on standard input. Throws Error or Damaged, naming the file.
  explicit PlaceQuery(const std::string& path);

  Placement placement() const;

  // The height at a place in real units or, with `on_lattice`, in lattice steps: OK, OUTSIDE,
  // VOID or BAD_TILE. Throws Error if a pack's file cannot be read.
  ExactAnswer height_at(Decimal x, Decimal y, bool on_lattice);

  // The heights along the line between two positions in real units. Throws Error as height_at.
  encoder::Profile profile(Position from, Position to);

  // The unit of heights.
  Unit vertical_unit() const { return vertical_; }

  // The answer of a device, which rounds the place, of at most kDeviceDecimals decimals, to 1/256
  // of a lattice step, and the height to 1/65536 of a z step.
  static constexpr int kDeviceDecimals = 7;
  ExactAnswer device_height_at(Decimal x, Decimal y, bool on_lattice);

 private:
  // A pack's tiles are read twice: by a device's code and by the host's.
  struct Pack {
    AskedPack device;
    std::unique_ptr<PackFile> file;
    std::shared_ptr<const bool> has_failed;  // a read of the file's bytes
  };

  std::vector<Axis> names_of_x(bool on_lattice) const;
  void expect_read() const;  // throws Error if a read of a pack's file has failed
  microtin_query_result stream_height_at(const Placement& place, Decimal x, Decimal y,
                                         int32_t* height);
  microtin_query_result pack_height_at(const Placement& place, Decimal x, Decimal y,
                                       int32_t* height);
  static std::variant<DecodedStream, Pack> opened(const std::string& path);
  static Pack opened_pack(const std::string& path);

  std::variant<DecodedStream, Pack> content_;
  SampledSurface surface_;
  Unit horizontal_ = Unit::kUnknown, vertical_ = Unit::kUnknown;
  uint32_t hint_ = 0;
};

}  // namespace microtin::product

#endif
