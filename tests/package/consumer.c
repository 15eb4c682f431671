// SPDX-License-Identifier: MIT
/* The smallest user of the library: C, and nothing but the public header. */
#ifdef MICROTIN_AMALGAMATION
#include "microtin.h"
#else
#include <microtin/microtin.h>
#endif

int main(void) {
  static const uint8_t bytes[64] = {'n', 'o', 't', ' ', 'o', 'n', 'e'};
  microtin_stream_info info;
  return microtin_read_stream_info(bytes, sizeof bytes, &info) == MICROTIN_STATUS_BAD_MAGIC ? 0 : 1;
}
