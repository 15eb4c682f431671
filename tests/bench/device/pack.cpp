// Reads a pack in flash and prints the instructions of service and queries, and the RAM.
#include "microtin/pack.h"

#include "tests/bench/device/instruction_counter.hpp"
#include "tests/firmware/linked_stream.hpp"
#include "tests/firmware/report.hpp"
#include "toolchains/firmware.h"

namespace {

constexpr uint32_t kSlots = 4, kCapacity = 1000;

size_t read_flash(void*, uint64_t offset, uint8_t* buffer, size_t size) {
  for (size_t i = 0; i < size; ++i) buffer[i] = stream_begin[static_cast<size_t>(offset) + i];
  return size;
}

void print(const char* what, uint32_t number) {
  microtin::print(put_char, what);
  microtin::print(put_char, " ");
  microtin::print(put_char, number);
  microtin::print(put_char, "\n");
}

}  // namespace

int firmware_main() {
  alignas(MICROTIN_ALIGNMENT) static uint8_t workspace[MICROTIN_PACK_BYTES(kSlots, kCapacity)];
  const microtin::InstructionCounter instructions;
  microtin_pack* pack = nullptr;
  microtin_pack_init(workspace, sizeof workspace, kSlots, kCapacity, &pack);
  // From the middle of the first tile, through the corner where four meet, into the fourth.
  microtin_pack_info info;
  microtin_course course = {0, 0, 0, 0};
  microtin_pack_service(pack, &course, 0, read_flash, nullptr);
  if (microtin_pack_header(pack, &info) == 0) return 1;
  const int64_t x = int64_t{info.tile_width} * 128, y = int64_t{info.tile_height} * 128;
  course = {x, y, 3 * x + 77, 3 * y + 99};
  const uint32_t begin = instructions.count();
  if (microtin_pack_service(pack, &course, 0, read_flash, nullptr) != MICROTIN_DONE) return 1;
  print("RAM, bytes", sizeof workspace);
  print("instructions to read three tiles", instructions.count() - begin);

  uint32_t hint = 0, most = 0, all = 0;
  constexpr uint32_t kQueries = 200;
  for (uint32_t i = 0; i < kQueries; ++i) {
    const uint32_t before = instructions.count();
    int32_t height = 0;
    const int64_t way = i;
    if (microtin_pack_height_at(pack, course.x + (course.x_end - course.x) * way / kQueries,
                                course.y + (course.y_end - course.y) * way / kQueries, &hint,
                                &height) != MICROTIN_HEIGHT) {
      return 1;
    }
    const uint32_t cost = instructions.count() - before;
    all += cost;
    most = cost > most ? cost : most;
  }
  print("height along a course, mean", all / kQueries);
  print("height along a course, most", most);

  int32_t highest = 0;
  const uint32_t before = instructions.count();
  if (microtin_pack_highest(pack, &course, &highest) != MICROTIN_HEIGHT) return 1;
  print("highest on the course", instructions.count() - before);

  static int16_t heights[28 * 32];
  const microtin_block block = {x / 256 * 256, y / 256 * 256, 256, 256, 28, 32, INT16_MIN};
  const uint32_t begun = instructions.count();
  microtin_pack_fill(pack, &block, heights);
  print("a block of 28 x 32 heights", instructions.count() - begun);
  return 0;
}
