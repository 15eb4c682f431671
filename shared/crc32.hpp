// CRC-32 as in zip and Ethernet: polynomial 0x04C11DB7, reflected, all ones before and after.
#ifndef MICROTIN_SHARED_CRC32_HPP
#define MICROTIN_SHARED_CRC32_HPP

#include <stddef.h>
#include <stdint.h>

#include "shared/tables.hpp"

namespace microtin {

// Feed 0 first, then each result: crc32(crc32(0, a), b) is the check of a followed by b.
inline uint32_t crc32(uint32_t crc, const uint8_t* bytes, size_t size) {
  crc = ~crc;
  for (size_t i = 0; i < size; ++i) {
    crc ^= bytes[i];
    crc = crc >> 4 ^ table_crc(crc & 15u);
    crc = crc >> 4 ^ table_crc(crc & 15u);
  }
  return ~crc;
}

}  // namespace microtin

#endif
