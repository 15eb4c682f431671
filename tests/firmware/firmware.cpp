// The device's side of the comparison: a stream in flash, decoded in small chunks.
#include "toolchains/firmware.hpp"

#include "tests/firmware/linked_stream.hpp"
#include "tests/firmware/report.hpp"

int firmware_main() {
  static microtin::Terrain<MICROTIN_MAX_VERTICES> terrain;
  static microtin::Decoder<MICROTIN_MAX_VERTICES> decoder(terrain);
  return microtin::report(put_char, terrain, decoder, stream_begin, stream_size(), 61) ? 0 : 1;
}
