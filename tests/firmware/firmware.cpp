// SPDX-License-Identifier: MIT
// The device's side of the comparison: a stream in flash, fed in small pieces as from a radio link.
#include "toolchains/firmware.h"

#include "microtin/microtin.hpp"
#include "tests/firmware/linked_stream.hpp"
#include "tests/firmware/report.hpp"

namespace {

template <uint32_t Capacity>
microtin_status decode(microtin::Decoder<Capacity>& decoder) {
  uint8_t piece[61];
  size_t at = 0;
  microtin_status status = MICROTIN_STATUS_NEED_INPUT;
  while (status == MICROTIN_STATUS_NEED_INPUT && at < stream_size()) {
    size_t size = 0;
    for (; size < sizeof piece && at + size < stream_size(); ++size) {
      piece[size] = stream_byte(at + size);
    }
    size_t used = 0;
    status = decoder.feed(piece, size, &used);
    at += used;
  }
  return decoder.finish();
}

}  // namespace

int firmware_main() {
  static microtin::Terrain<MICROTIN_CAPACITY> terrain;
  static microtin::Decoder<MICROTIN_CAPACITY> decoder(terrain);
  const microtin_status status = decode(decoder);
  microtin::report(put_char, terrain.mesh(), status);
  if (status != MICROTIN_STATUS_OK) return 1;
  if (microtin::compact_agrees(terrain.mesh(), MICROTIN_MESH_BYTES(MICROTIN_CAPACITY), &decoder,
                               sizeof decoder)) {
    return 0;
  }
  microtin::print(put_char, "its compact form differs\n");
  return 1;
}
