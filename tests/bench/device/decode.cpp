// Decodes a stream in flash, read in place, and prints its vertices and the instructions it took.
#include "tests/firmware/report.hpp"
#include "toolchains/firmware.hpp"

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
  const size_t size = static_cast<size_t>(stream_end - stream_begin);
  const InstructionCounter instructions;
  static microtin::Decoder<MICROTIN_MAX_VERTICES> decoder(terrain);
  size_t used = 0;
  decoder.feed(stream_begin, size, &used);
  const microtin_status status = decoder.finish();
  const uint32_t count = instructions.count();

  microtin_info info;
  microtin_peek(stream_begin, size, &info);
  microtin::print(put_char, info.vertices);
  microtin::print(put_char, " ");
  microtin::print(put_char, count);
  microtin::print(put_char, "\n");
  return status == MICROTIN_DONE ? 0 : 1;
}
