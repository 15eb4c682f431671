// SPDX-License-Identifier: MIT
// CRC-32 as in zip and Ethernet: polynomial 0x04C11DB7, reflected, all ones before and after.
#ifndef MICROTIN_SHARED_CRC32_HPP
#define MICROTIN_SHARED_CRC32_HPP

#include <stddef.h>
#include <stdint.h>

#include "shared/tables.hpp"

namespace microtin {

// Shifts eight bits out of a check: one by one where size counts, otherwise by fours.
#if defined(__OPTIMIZE_SIZE__)

inline uint32_t shift_byte(uint32_t crc) {
  for (int i = 0; i < 8; ++i) crc = crc >> 1 ^ ((crc & 1u) != 0 ? 0xEDB88320u : 0u);
  return crc;
}

#else

// What four bits shifted out add.
constexpr uint32_t kCrcTable[16] MICROTIN_IN_FLASH = {
    0x00000000, 0x1DB71064, 0x3B6E20C8, 0x26D930AC, 0x76DC4190, 0x6B6B51F4, 0x4DB26158, 0x5005713C,
    0xEDB88320, 0xF00F9344, 0xD6D6A3E8, 0xCB61B38C, 0x9B64C2B0, 0x86D3D2D4, 0xA00AE278, 0xBDBDF21C,
};

inline uint32_t shift_byte(uint32_t crc) {
  for (int i = 0; i < 2; ++i) crc = crc >> 4 ^ read_table(kCrcTable + (crc & 15u));
  return crc;
}

#endif

#if defined(MICROTIN_LARGE_TABLES)

// What each of four bytes shifted out together adds: the last of them first. 4 KB.
struct CrcTable {
  uint32_t behind[4][256];

  constexpr CrcTable() : behind() {
    for (uint32_t byte = 0; byte < 256; ++byte) {
      uint32_t crc = byte;
      for (auto& table : behind) {
        for (int i = 0; i < 8; ++i) crc = crc >> 1 ^ ((crc & 1u) != 0 ? 0xEDB88320u : 0u);
        table[byte] = crc;
      }
    }
  }
};

constexpr CrcTable kCrcOfFour{};

// Takes four bytes at a time, as long as there are four.
inline uint32_t shift_fours(uint32_t crc, const uint8_t*& bytes, size_t& size) {
  for (; size >= 4; size -= 4, bytes += 4) {
    crc ^= static_cast<uint32_t>(bytes[0]) | static_cast<uint32_t>(bytes[1]) << 8 |
           static_cast<uint32_t>(bytes[2]) << 16 | static_cast<uint32_t>(bytes[3]) << 24;
    crc = kCrcOfFour.behind[3][crc & 255u] ^ kCrcOfFour.behind[2][crc >> 8 & 255u] ^
          kCrcOfFour.behind[1][crc >> 16 & 255u] ^ kCrcOfFour.behind[0][crc >> 24];
  }
  return crc;
}

#else

inline uint32_t shift_fours(uint32_t crc, const uint8_t*&, size_t&) {
  return crc;
}

#endif

// The check of anything and its own check, low byte first, behind it.
constexpr uint32_t kCheckedCrc = 0x2144DF1C;

// Feed 0 first, then each result: crc32(crc32(0, a), b) is the check of a followed by b.
MICROTIN_ONE_COPY MICROTIN_OUT_OF_LINE inline uint32_t crc32(uint32_t crc, const uint8_t* bytes,
                                                             size_t size) {
  crc = shift_fours(~crc, bytes, size);
  for (size_t i = 0; i < size; ++i) crc = shift_byte(crc ^ bytes[i]);
  return ~crc;
}

}  // namespace microtin

#endif
