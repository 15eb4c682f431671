// SPDX-License-Identifier: MIT
// Must be rejected by symbols.cmake: it allocates.
#include <stddef.h>

extern "C" void* malloc(size_t size);

extern "C" void* planted() {
  return malloc(1);
}
