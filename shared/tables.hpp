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

// 4096 * log2(1 + i / 32)
constexpr uint16_t kLog2Table[33] MICROTIN_IN_FLASH = {
    0,    182,  358,  530,  696,  858,  1016, 1169, 1319, 1465, 1607,
    1746, 1882, 2015, 2145, 2272, 2396, 2518, 2637, 2754, 2869, 2982,
    3092, 3200, 3307, 3412, 3514, 3615, 3715, 3812, 3908, 4003, 4096,
};

inline uint16_t table_log2(uint32_t i) {
  return read_table(kLog2Table + i);
}

// 32768 * (2^(i / 32) - 1)
constexpr uint16_t kExp2Table[33] MICROTIN_IN_FLASH = {
    0,     718,   1451,  2200,  2966,  3748,  4548,  5365,  6200,  7053,  7925,
    8816,  9727,  10657, 11608, 12580, 13573, 14588, 15625, 16684, 17767, 18874,
    20005, 21160, 22341, 23548, 24781, 26041, 27329, 28645, 29989, 31364, 32768,
};

inline uint16_t table_exp2(uint32_t i) {
  return read_table(kExp2Table + i);
}

// 32768 * ((1 + k^2) * acot(k) - k), the area of a circular segment over a chord of length 2 whose
// inscribed angle has the cotangent -k = -i / 8
constexpr uint16_t kSegmentTable[65] MICROTIN_IN_FLASH = {
    51472, 44042, 37968, 33013, 28965, 25644, 22902, 20619, 18704, 17082, 15697, 14504, 13468,
    12562, 11765, 11058, 10428, 9863,  9355,  8894,  8476,  8094,  7745,  7423,  7127,  6853,
    6599,  6363,  6143,  5937,  5745,  5564,  5395,  5235,  5084,  4942,  4808,  4680,  4559,
    4444,  4335,  4231,  4131,  4037,  3946,  3859,  3776,  3697,  3621,  3548,  3478,  3410,
    3345,  3283,  3222,  3164,  3108,  3054,  3002,  2951,  2902,  2855,  2809,  2765,  2722,
};

inline uint16_t table_segment(uint32_t i) {
  return read_table(kSegmentTable + i);
}

}  // namespace microtin

#endif
