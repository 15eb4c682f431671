// SPDX-License-Identifier: MIT
// Asks the decoder's own macros.
#include "encoder/stream/device_ram.hpp"

#include "microtin/microtin.h"
#include "shared/format.hpp"

namespace microtin::stream {

uint64_t device_ram(uint32_t vertices) {
  const unsigned long n = vertices;
  return n <= MICROTIN_MAX_VERTICES_FOR(16)
             ? MICROTIN_MESH_BYTES_FOR(n, 16) + MICROTIN_DECODER_BYTES_FOR(n, 16)
             : MICROTIN_MESH_BYTES_FOR(n, 32) + MICROTIN_DECODER_BYTES_FOR(n, 32);
}

uint32_t most_vertices(uint64_t bytes) {
  uint32_t fits = 2, too_many = kMaxVertices + 1;
  while (too_many - fits > 1) {
    const uint32_t middle = fits + (too_many - fits) / 2;
    (device_ram(middle) <= bytes ? fits : too_many) = middle;
  }
  return fits == 2 ? 0 : fits;
}

}  // namespace microtin::stream
