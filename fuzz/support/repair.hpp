// SPDX-License-Identifier: MIT
// Makes the checks of a damaged stream right again, so that fuzzing reaches what lies behind them.
#ifndef MICROTIN_FUZZ_SUPPORT_REPAIR_HPP
#define MICROTIN_FUZZ_SUPPORT_REPAIR_HPP

#include <cstdint>
#include <cstring>

#include "shared/crc32.hpp"
#include "shared/format.hpp"
#include "shared/header.hpp"
#include "tests/support/layers.hpp"

namespace microtin::tests {

inline void write_u32(uint8_t* bytes, uint32_t value) {
  for (int i = 0; i < 4; ++i) bytes[i] = static_cast<uint8_t>(value >> 8 * i);
}

inline void write_check(uint8_t* bytes, size_t from, size_t at) {
  write_u32(bytes + at, crc32(0, bytes + from, at - from));
}

// Sets magic, version, and the check of the header and of every section that is there whole. False
// if a damaged length ends that.
inline bool repair(uint8_t* bytes, size_t size) {
  if (size < kIdentityBytes) return false;
  std::memcpy(bytes, kMagic, sizeof kMagic);
  bytes[4] = kVersion;
  size_t from = 0;  // where the bytes begin that the next check is of
  const uint8_t* next = bytes + kIdentityBytes;
  uint64_t length = 0;
  while (read_varint(&next, bytes + size, &length) && length <= size) {
    const size_t at = static_cast<size_t>(next - bytes) + static_cast<size_t>(length);
    if (at > size || size - at < kCheckBytes) return false;
    write_check(bytes, from, at);
    from = at + kCheckBytes;
    if (from == size) return true;
    next = bytes + from;
  }
  return false;
}

}  // namespace microtin::tests

#endif
