// SPDX-License-Identifier: MIT
// Flies over a grid of blocks such as ArduPilot's in flash, twelve of them in RAM: instructions of
// reading and queries, bytes read, RAM, heights.
#include "tests/bench/device/flight.hpp"
#include "tests/bench/device/flight_log.hpp"
#include "tests/bench/device/grid_file.hpp"
#include "tests/bench/device/instruction_counter.hpp"
#include "tests/firmware/linked_stream.hpp"

namespace {

using namespace microtin;

constexpr uint32_t kSlots = 12;

struct Slot {
  int16_t heights[GridFile::kBlockRows][GridFile::kBlockColumns];
  uint32_t block, wanted;
};

struct Cache {
  Slot slots[kSlots];
  uint32_t clock, bytes_read;
} cache;

// From flash as a card.
void read(uint32_t offset, void* to, uint32_t size) {
  for (uint32_t i = 0; i < size; ++i) static_cast<uint8_t*>(to)[i] = stream_begin[offset + i];
}

// Finds a block, or reads it in the place of the one not wanted for longest.
const Slot& block_at(uint32_t number) {
  ++cache.clock;
  Slot* oldest = &cache.slots[0];
  for (Slot& slot : cache.slots) {
    if (slot.block == number) {
      slot.wanted = cache.clock;
      return slot;
    }
    if (slot.wanted < oldest->wanted) oldest = &slot;
  }
  read(GridFile::kHeaderBytes + number * GridFile::kBlockBytes, oldest->heights,
       sizeof oldest->heights);
  cache.bytes_read += GridFile::kBlockBytes;
  oldest->block = number;
  oldest->wanted = cache.clock;
  return *oldest;
}

// Decimetres, bilinear. Like ArduPilot, of the four posts that a block holds together.
int32_t height_at(const GridFile& file, Post post) {
  const uint32_t x = static_cast<uint32_t>(post.x) * file.column_millimetres,
                 y = static_cast<uint32_t>(post.y) * file.row_millimetres;
  const uint32_t column = x / file.spacing_millimetres, row = y / file.spacing_millimetres;
  const int32_t spacing = static_cast<int32_t>(file.spacing_millimetres / 100);
  const int32_t u = static_cast<int32_t>(x % file.spacing_millimetres / 100),
                v = static_cast<int32_t>(y % file.spacing_millimetres / 100);  // decimetres
  const Slot& slot =
      block_at(row / GridFile::kOwnRows * file.block_columns + column / GridFile::kOwnColumns);
  const int16_t* south = &slot.heights[row % GridFile::kOwnRows][column % GridFile::kOwnColumns];
  const int16_t* north = south + GridFile::kBlockColumns;
  // Heights are below 2^13 metres, the spacing is 1,000 decimetres: sums stay below 2^31.
  const int32_t on_south = south[0] * (spacing - u) + south[1] * u,
                on_north = north[0] * (spacing - u) + north[1] * u;
  return (on_south / 4 * (spacing - v) + on_north / 4 * v) / (spacing * spacing / 40);
}

}  // namespace

int firmware_main() {
  GridFile file;
  read(0, &file, sizeof file);
  for (Slot& slot : cache.slots) slot.block = UINT32_MAX;
  const InstructionCounter instructions;
  const Flight flight(file.x_max, file.y_max);
  Costs known, read;
  for (int32_t i = 0; i < flight.posts(); ++i) {
    const uint32_t bytes = cache.bytes_read, before = instructions.count();
    const int32_t height = height_at(file, flight.post(i));
    const uint32_t cost = instructions.count() - before;
    (cache.bytes_read == bytes ? known : read).add(cost);
    log_height(height);
  }
  log("RAM", sizeof cache);
  log("bytes read", cache.bytes_read);
  log("service all", static_cast<uint32_t>(read.all));
  log("service most", read.most);
  log("height mean", known.mean());
  log("height most", known.most);
  return 0;
}
