// Makes the checks of a damaged stream right again, so that fuzzing reaches what lies behind them.
#ifndef MICROTIN_FUZZ_REPAIR_HPP
#define MICROTIN_FUZZ_REPAIR_HPP

#include <cstdint>
#include <cstring>
#include <vector>

#include "shared/crc32.hpp"
#include "shared/format.hpp"
#include "shared/header.hpp"

namespace microtin {

inline void write_check(std::vector<uint8_t>& bytes, size_t from, size_t at) {
  const uint32_t check = crc32(0, bytes.data() + from, at - from);
  for (size_t i = 0; i < kCheckBytes; ++i) bytes[at + i] = static_cast<uint8_t>(check >> 8 * i);
}

// Sets magic, version, and the check of the header and of every section that is there whole. False
// if a damaged length ends that.
inline bool repair(std::vector<uint8_t>& bytes) {
  if (bytes.size() < kIdentityBytes) return false;
  std::memcpy(bytes.data(), kMagic, sizeof kMagic);
  bytes[4] = kVersion;
  if (bytes.size() < fixed_header_bytes(bytes.data())) return false;
  FixedHeader header;
  read_fixed_header(bytes.data(), &header);
  size_t at = size_t{header.bytes} + header.placement_bytes + header.note_bytes;
  size_t from = 0;
  while (at <= bytes.size() && bytes.size() - at >= kCheckBytes) {
    write_check(bytes, from, at);
    from = at + kCheckBytes;
    const uint8_t* next = bytes.data() + from;
    uint64_t payload = 0;
    if (next == bytes.data() + bytes.size()) return true;
    if (!read_varint(&next, bytes.data() + bytes.size(), &payload)) return false;
    if (payload > bytes.size()) return false;
    at = static_cast<size_t>(next - bytes.data()) + static_cast<size_t>(payload);
  }
  return false;
}

}  // namespace microtin

#endif
