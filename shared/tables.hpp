// SPDX-License-Identifier: MIT
// The constant tables, and the one way to read them: on AVR they stay in flash.
#ifndef MICROTIN_SHARED_TABLES_HPP
#define MICROTIN_SHARED_TABLES_HPP

#include <stdint.h>

#include "shared/compiler.hpp"

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

}  // namespace microtin

#endif
