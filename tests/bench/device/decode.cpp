// Decodes a stream in flash, read in place, and prints its vertices and the instructions it took.
#include "microtin/microtin.hpp"
#include "tests/bench/device/instruction_counter.hpp"
#include "tests/firmware/linked_stream.hpp"
#include "tests/firmware/report.hpp"
#include "toolchains/firmware.hpp"

int firmware_main() {
  static microtin::Terrain<MICROTIN_MAX_VERTICES> terrain;
  const microtin::InstructionCounter instructions;
  static microtin::Decoder<MICROTIN_MAX_VERTICES> decoder(terrain);
  size_t used = 0;
  decoder.feed(stream_begin, stream_size(), &used);
  const microtin_status status = decoder.finish();
  const uint32_t count = instructions.count();

  microtin_info info;
  microtin_peek(stream_begin, stream_size(), &info);
  microtin::print(put_char, info.vertices);
  microtin::print(put_char, " ");
  microtin::print(put_char, count);
  microtin::print(put_char, "\n");
  return status == MICROTIN_DONE ? 0 : 1;
}
