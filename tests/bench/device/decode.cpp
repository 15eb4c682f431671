// Decodes a stream in flash, read in place, and prints its vertices and the instructions it took.
#include "microtin/microtin.hpp"
#include "tests/firmware/linked_stream.hpp"
#include "tests/firmware/report.hpp"
#include "toolchains/firmware.hpp"

namespace {

// A CMSDK timer: counts down, once every 40 ns. QEMU with -icount shift=6 takes 64 ns for each
// instruction.
class InstructionCounter {
 public:
  InstructionCounter() {
    timer()[kValue] = UINT32_MAX;
    timer()[kControl] = 1;
  }

  uint32_t count() const {
    return static_cast<uint32_t>(uint64_t{UINT32_MAX - timer()[kValue]} * 40 / 64);
  }

 private:
  enum Register { kControl, kValue };

  static volatile uint32_t* timer() { return reinterpret_cast<volatile uint32_t*>(0x40000000); }
};

}  // namespace

int firmware_main() {
  static microtin::Terrain<MICROTIN_MAX_VERTICES> terrain;
  const InstructionCounter instructions;
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
