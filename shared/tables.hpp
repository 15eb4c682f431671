// The constant tables, and the one way to read them: on AVR they stay in flash.
#ifndef MICROTIN_SHARED_TABLES_HPP
#define MICROTIN_SHARED_TABLES_HPP

#include <stdint.h>

#if defined(__AVR__)
#include <avr/pgmspace.h>
#define MICROTIN_IN_FLASH PROGMEM
#else
#define MICROTIN_IN_FLASH
#endif

namespace microtin {

template <class Number>
Number read_table(const Number* entry) {
#if defined(__AVR__)
  const uint8_t* const bytes = reinterpret_cast<const uint8_t*>(entry);
  Number number = 0;
  for (uint8_t i = sizeof(Number); i-- != 0;) {
    number = static_cast<Number>(static_cast<uint32_t>(number) << 8 | pgm_read_byte(bytes + i));
  }
  return number;
#else
  return *entry;
#endif
}

// What four bits shifted out add to a CRC-32.
constexpr uint32_t kCrcTable[16] MICROTIN_IN_FLASH = {
    0x00000000, 0x1DB71064, 0x3B6E20C8, 0x26D930AC, 0x76DC4190, 0x6B6B51F4, 0x4DB26158, 0x5005713C,
    0xEDB88320, 0xF00F9344, 0xD6D6A3E8, 0xCB61B38C, 0x9B64C2B0, 0x86D3D2D4, 0xA00AE278, 0xBDBDF21C,
};

inline uint32_t table_crc(uint32_t i) {
  return read_table(kCrcTable + i);
}

}  // namespace microtin

#endif
