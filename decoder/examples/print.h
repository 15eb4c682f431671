// SPDX-License-Identifier: MIT
/* Printing for the examples. */
#ifndef MICROTIN_EXAMPLES_PRINT_H
#define MICROTIN_EXAMPLES_PRINT_H

#include <stdint.h>

#include "toolchains/firmware.h"

static inline void print(const char* text) {
  while (*text != '\0') put_char(*text++);
}

static inline void print_number(int32_t number) {
  char digits[10];
  int count = 0;
  uint32_t rest = number < 0 ? 0u - (uint32_t)number : (uint32_t)number;
  if (number < 0) put_char('-');
  do {
    digits[count++] = (char)('0' + rest % 10u);
    rest /= 10u;
  } while (rest != 0);
  while (count != 0) put_char(digits[--count]);
}

#endif
