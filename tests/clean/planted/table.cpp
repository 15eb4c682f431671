// SPDX-License-Identifier: MIT
// Must be rejected by symbols.cmake on AVR: a table that is not kept in flash.
#include <stdint.h>

extern "C" const uint16_t kPlanted[4];
const uint16_t kPlanted[4] = {2, 3, 5, 7};
