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

inline uint16_t read_table(const uint16_t* entry) {
#if defined(__AVR__)
  return pgm_read_word(entry);
#else
  return *entry;
#endif
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
// inscribed angle has the cotangent -k: at 256 k + 64 = 2^(6 + i / 4), linear within octaves
constexpr uint16_t kSegmentTable[37] MICROTIN_IN_FLASH = {
    51472, 47572, 44042, 40850, 37968, 33013, 28965, 25644, 22902, 18704, 15697, 13468, 11765,
    9355,  7745,  6599,  5745,  4559,  3776,  3222,  2809,  2236,  1856,  1587,  1386,  1106,
    919,   787,   688,   549,   457,   392,   343,   274,   228,   195,   171,
};

inline uint16_t table_segment(uint32_t i) {
  return read_table(kSegmentTable + i);
}

}  // namespace microtin

#endif
