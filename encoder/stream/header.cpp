// SPDX-License-Identifier: MIT
// Header fields as format-stream.md lays them down, and the numbers that they consist of.
#include "encoder/stream/header.hpp"

#include "encoder/base/error.hpp"
#include "shared/crc32.hpp"
#include "shared/header.hpp"

namespace microtin::stream {
namespace {

using Bytes = std::vector<uint8_t>;

bool is_lattice_itself(const Axis& axis) {
  return axis.offset == 0 && axis.numerator == 1 && axis.denominator == 1;
}

}  // namespace

uint64_t zigzag(int64_t value) {
  return static_cast<uint64_t>(value) << 1 ^ static_cast<uint64_t>(value >> 63);
}

void append_axis(Bytes& bytes, const Axis& axis) {
  append_varint(bytes, zigzag(axis.offset));
  append_varint(bytes, axis.numerator);
  append_varint(bytes, axis.denominator);
}

void append_varint(Bytes& bytes, uint64_t value) {
  int groups = 1;
  while (groups < 10 && value >> 7 * groups != 0) ++groups;
  while (--groups > 0) bytes.push_back(static_cast<uint8_t>(value >> 7 * groups | 128));
  bytes.push_back(static_cast<uint8_t>(value & 127));
}

void append_number(Bytes& bytes, uint64_t value, int width) {
  for (int i = 0; i < width; ++i) bytes.push_back(static_cast<uint8_t>(value >> 8 * i));
}

void append_check(Bytes& bytes, size_t from) {
  append_number(bytes, crc32(0, bytes.data() + from, bytes.size() - from), 4);
}

Bytes write_placement(const Placement& p) {
  Bytes content;
  if (is_lattice_itself(p.x) && is_lattice_itself(p.y) && is_lattice_itself(p.z)) return content;
  append_axis(content, p.x);
  append_axis(content, p.y);
  append_axis(content, p.z);
  return content;
}

Bytes write_header(const Contract& contract, const Metadata& metadata) {
  const Bytes placement = write_placement(metadata.placement);
  const Bytes notes = write_notes(metadata);
  Bytes payload;
  const bool has_margins = contract.below != kNotStated || contract.above != kNotStated;
  append_varint(payload,
                (contract.has_heights ? kHasHeights : 0) | (contract.has_voids ? kHasVoids : 0) |
                    (placement.empty() ? 0 : kHasPlacement) |
                    (contract.odd_origin_x ? kOddOriginX : 0) |
                    (contract.odd_origin_y ? kOddOriginY : 0) | (has_margins ? kHasMargins : 0) |
                    static_cast<uint32_t>(contract.coding) << 3 | contract.degree << 5);
  append_varint(payload, contract.vertices);
  append_varint(payload, contract.x_max);
  append_varint(payload, contract.y_max);
  if (has_margins) {
    append_varint(payload, contract.below + 1u);  // not stated: 0
    append_varint(payload, contract.above + 1u);
  }
  payload.insert(payload.end(), placement.begin(), placement.end());
  payload.insert(payload.end(), notes.begin(), notes.end());
  Bytes header(kMagic, kMagic + sizeof kMagic);
  header.push_back(kVersion);
  append_varint(header, payload.size());
  header.insert(header.end(), payload.begin(), payload.end());
  append_check(header, 0);
  return header;
}

Header read_header(const Bytes& stream) {
  Header header;
  microtin_status status = microtin_read_stream_info(stream.data(), stream.size(), &header.info);
  if (status == MICROTIN_STATUS_NEED_INPUT) status = MICROTIN_STATUS_TRUNCATED;
  if (status != MICROTIN_STATUS_OK) throw Error(describe(status));
  const uint8_t* const end = stream.data() + header.info.header_bytes - kCheckBytes;
  const uint8_t* next = stream.data() + kIdentityBytes;
  uint64_t length = 0;
  microtin_axis axis[3];
  read_varint(&next, end, &length);
  read_header(&next, end, &header.contract, axis);
  header.metadata.placement = {axis[0], axis[1], axis[2]};
  header.metadata.everywhere = {header.contract.below, header.contract.above};
  read_notes(next, end, header.metadata);
  return header;
}

Bytes with_metadata(const Bytes& stream, const Metadata& metadata) {
  const Header old = read_header(stream);
  Contract contract = old.contract;
  contract.below = metadata.everywhere.below;
  contract.above = metadata.everywhere.above;
  Bytes changed = write_header(contract, metadata);
  changed.insert(changed.end(), stream.begin() + old.info.header_bytes, stream.end());
  read_header(changed);  // throws if a decoder would refuse it; the rest was not touched
  return changed;
}

}  // namespace microtin::stream
