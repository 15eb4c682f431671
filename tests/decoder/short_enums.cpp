// SPDX-License-Identifier: MIT
#include "tests/decoder/short_enums.h"

size_t short_enums_size(uint32_t i) {
  const size_t sizes[] = MICROTIN_PUBLIC_STRUCTS;
  return sizes[i];
}

size_t short_enums_status_size(void) {
  return sizeof(microtin_status);
}

uint32_t short_enums_why(const microtin_pack* pack, uint32_t i) {
  uint32_t tile, why = 0xA5A5A5A5u;
  return microtin_pack_bad_tile(pack, i, &tile, &why) == MICROTIN_STATUS_OK ? why : 0;
}
