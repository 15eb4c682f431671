// SPDX-License-Identifier: MIT
// The stream of the file MICROTIN_STREAM, as it is. Nothing but assembly: one object of it is all
// that images of different streams differ by.
#if defined(__AVR__)
#define SECTION ".section .progmem.data.stream, \"a\""
#elif defined(__wasm__)
#define SECTION ".section .rodata.stream, \"\", @"
#else
#define SECTION ".section .rodata.stream, \"a\""
#endif

asm(SECTION R"(
  .balign 4
  .globl stream_begin, stream_end
stream_begin:
  .incbin ")" MICROTIN_STREAM R"("
stream_end:
  .size stream_begin, stream_end - stream_begin
  .size stream_end, 0
)");
