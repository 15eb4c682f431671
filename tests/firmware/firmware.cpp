// The device's side of the comparison: a stream in flash, decoded in small chunks.
#include "toolchains/firmware.hpp"

#include "tests/firmware/report.hpp"

asm(R"(
  .section .rodata.stream, "a"
  .balign 4
stream_begin:
  .incbin ")" MICROTIN_STREAM R"("
stream_end:
  .previous
)");
extern "C" const uint8_t stream_begin[];
extern "C" const uint8_t stream_end[];

int firmware_main() {
  static microtin::Terrain<MICROTIN_MAX_VERTICES> terrain;
  static microtin::Decoder<MICROTIN_MAX_VERTICES> decoder(terrain);
  const size_t size = static_cast<size_t>(stream_end - stream_begin);
  return microtin::report(put_char, terrain, decoder, stream_begin, size, 61) ? 0 : 1;
}
