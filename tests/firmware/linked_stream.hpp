// The stream of the file MICROTIN_STREAM, linked into the image as it is.
#ifndef MICROTIN_TESTS_FIRMWARE_LINKED_STREAM_HPP
#define MICROTIN_TESTS_FIRMWARE_LINKED_STREAM_HPP

#include <stddef.h>
#include <stdint.h>

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

inline size_t stream_size() {
  return static_cast<size_t>(stream_end - stream_begin);
}

#endif
